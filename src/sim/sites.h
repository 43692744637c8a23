#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace faba {

struct Grid;

/// Which sites of a grid are occupied: one bit per site, so that the sites of a million pixels fit into the
/// caches.
class Sites {
 public:
  explicit Sites(std::size_t sites = 0) : words_((sites + 63) / 64) {}

  bool taken(std::int32_t site) const { return (word(site) >> (site & 63) & 1) != 0; }
  void take(std::int32_t site) { word(site) |= bit(site); }
  void leave(std::int32_t site) { word(site) &= ~bit(site); }
  /// As leave(home) and take(site) if `go` is true, else nothing; without a branch.
  void move(std::int32_t home, std::int32_t site, bool go) {
    word(home) &= ~(std::uint64_t{go} << (home & 63));
    word(site) |= std::uint64_t{go} << (site & 63);
  }
  /// The word of a site; its bit is site & 63. Sites of different words may be changed by different threads.
  std::uint64_t& word(std::int32_t site) { return words_[std::size_t(site) >> 6]; }
  std::uint64_t word(std::int32_t site) const { return words_[std::size_t(site) >> 6]; }
  std::span<std::uint64_t> words() { return words_; }
  std::span<const std::uint64_t> words() const { return words_; }
  /// Adds or removes sites at the end; new ones are free.
  void resize_words(std::size_t words) { words_.resize(words); }
  void clear() { words_.assign(words_.size(), 0); }
  static std::uint64_t bit(std::int32_t site) { return std::uint64_t{1} << (site & 63); }

  friend bool operator==(const Sites&, const Sites&) = default;

 private:
  std::vector<std::uint64_t> words_;
};

/// site[i] = grid.index(x[i], y[i]).
void find_sites(const Grid& grid, std::span<const float> x, std::span<const float> y, std::int32_t* site);

}  // namespace faba
