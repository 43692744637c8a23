#include "field/library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

namespace faba {
namespace {

constexpr std::size_t kTies = 16;  // entries with equal zeros among which the least power is selected

double power(const LibraryEntry& e) {
  double p = 0;
  for (const double i : e.current) p += i * i;
  return p;
}

/// Dataset interface of nanoflann.
struct Zeros {
  std::vector<std::size_t> entry;
  std::vector<Vec2> at;
  std::size_t kdtree_get_point_count() const { return at.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return axis ? at[i].y : at[i].x; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

struct FieldLibrary::Tree {
  Zeros zeros;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Zeros>, Zeros, 2> index;
  explicit Tree(Zeros z) : zeros(std::move(z)), index(2, zeros) { index.buildIndex(); }

  // The entries that trap cells of a polarity.
  static std::unique_ptr<Tree> of(const std::vector<LibraryEntry>& all, int polarity) {
    // For north-seeking cells, which are trapped where both gradients are negative.
    const auto worst = [&](const LibraryEntry& e) { return polarity > 0 ? e.gradient[1] : -e.gradient[0]; };
    const auto sum = [&](const LibraryEntry& e) { return polarity * (e.gradient[0] + e.gradient[1]); };
    const bool traps =
        std::any_of(all.begin(), all.end(), [&](const LibraryEntry& e) { return worst(e) < 0; });
    Zeros z;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!((traps ? worst(all[i]) : sum(all[i])) < 0)) continue;
      z.entry.push_back(i);
      z.at.push_back(all[i].zero);
    }
    return std::make_unique<Tree>(std::move(z));
  }
};

FieldLibrary::FieldLibrary(Content content) : content_(std::move(content)) {
  north_ = Tree::of(content_.entries, 1);
  south_ = Tree::of(content_.entries, -1);
}

FieldLibrary::~FieldLibrary() = default;

FieldTable FieldLibrary::table(const Field& field, const std::string& coil_hash) const {
  const auto other = [&] {
    return Error(
        Errc::input, content_.source,
        "was made for a different coil system; create it again with `faba field library RIG.toml --out "
        "FILE --force`");
  };
  if (content_.rig != coil_hash ||
      (!content_.entries.empty() && content_.entries.front().current.size() != field.coils()))
    throw other();
  FieldTable table(field, content_.grid);
  for (const std::size_t i : {std::size_t(0), content_.entries.size() / 2, content_.entries.size() - 1}) {
    if (i >= content_.entries.size()) continue;
    table.set(content_.entries[i].current);
    const std::vector<float> stored = content_.field(i);
    if (!std::equal(stored.begin(), stored.end(), table.nodes().begin(), [](float a, float b) {
          return std::fabs(a - b) <= 1e-6f * std::max(std::fabs(a), 1e-6f);
        }))
      throw other();
  }
  return table;
}

std::optional<std::size_t> FieldLibrary::nearest(Vec2 at, int polarity) const {
  const Tree& tree = polarity > 0 ? *north_ : *south_;
  std::array<std::uint32_t, kTies> found{};
  std::array<double, kTies> square{};
  const std::array<double, 2> query{at.x, at.y};
  const std::size_t n = tree.index.knnSearch(query.data(), kTies, found.data(), square.data());
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < n; ++i) {
    // Zeros within 1 nm of each other are considered equal.
    if (std::sqrt(square[i]) > std::sqrt(square[0]) + 1e-9) break;
    const std::size_t entry = tree.zeros.entry[found[i]];
    if (!best || power(content_.entries[entry]) < power(content_.entries[*best])) best = entry;
  }
  return best;
}

}  // namespace faba
