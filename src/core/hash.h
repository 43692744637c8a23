#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace faba {

/// FNV-1a, 64 bits, over little-endian bytes. A hash for comparing runs; not cryptographic.
class Hash {
 public:
  void bytes(const void* p, std::size_t n) {
    const auto* b = static_cast<const unsigned char*>(p);
    for (std::size_t i = 0; i < n; ++i) value_ = (value_ ^ b[i]) * 0x100000001b3ull;
  }
  void text(std::string_view s) { bytes(s.data(), s.size()); }
  template <class T>
  void values(std::span<const T> v) {
    bytes(v.data(), v.size_bytes());
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void value(T v) { bytes(&v, sizeof v); }
  std::uint64_t result() const { return value_; }
  /// Sixteen hexadecimal digits.
  std::string hex() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ull;
};

}  // namespace faba
