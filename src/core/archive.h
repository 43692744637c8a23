#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/vec.h"

namespace faba {

/// A checkpoint that is written or read. One function per class describes both directions:
///   void Thing::archive(Archive& a) { a & count_ & position_ & history_; }
/// Little-endian, fixed widths. Reading past the end throws Error(input).
class Archive {
 public:
  Archive() = default;  ///< for writing
  explicit Archive(std::vector<std::uint8_t> bytes)
      : bytes_(std::move(bytes)), reading_(true) {}  ///< for reading

  bool reading() const { return reading_; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  bool at_end() const { return at_ == bytes_.size(); }
  /// Takes memory for `bytes` at once instead of step by step.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  /// Writes a value that must not change; only for writing.
  template <class T>
  Archive& write(const T& v) {
    return *this & const_cast<T&>(v);
  }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> Archive& operator&(T& v) {
    raw(&v, sizeof v);
    return *this;
  }
  Archive& operator&(Vec2& v) { return *this & v.x & v.y; }
  Archive& operator&(std::string& s) {
    std::uint64_t n = length(s.size(), 1);
    s.resize(n);
    raw(s.data(), n);
    return *this;
  }
  template <class T>
  Archive& operator&(std::vector<T>& v) {
    const std::uint64_t n = length(v.size(), std::is_arithmetic_v<T> ? sizeof(T) : 1);
    v.resize(n);
    if constexpr (std::is_arithmetic_v<T>)
      raw(v.data(), n * sizeof(T));
    else
      for (auto& e : v) *this& e;
    return *this;
  }
  template <class T>
  requires requires(T& t, Archive& a) { t.archive(a); }
  Archive& operator&(T& v) {
    v.archive(*this);
    return *this;
  }

 private:
  std::uint64_t length(std::size_t now, std::size_t least_bytes_each) {
    std::uint64_t n = now;
    *this& n;
    if (reading_ && n > (bytes_.size() - at_) / least_bytes_each)
      throw Error(Errc::input, "checkpoint", "is corrupt");
    return n;
  }
  void raw(void* p, std::size_t n) {
    if (n == 0) return;
    if (reading_) {
      if (n > bytes_.size() - at_) throw Error(Errc::input, "checkpoint", "is truncated");
      std::memcpy(p, bytes_.data() + at_, n);
      at_ += n;
    } else {
      const auto* b = static_cast<const std::uint8_t*>(p);
      bytes_.insert(bytes_.end(), b, b + n);
    }
  }
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool reading_ = false;
};

}  // namespace faba
