#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace faba {

/// SHA-256 (FIPS 180-4): identifies the content of files; `sha256sum` prints the same digits.
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// The digest of everything added, 64 hexadecimal digits. Nothing can be added after it.
  std::string hex();

 private:
  void block(const unsigned char* p);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> waiting_{};
  std::size_t filled_ = 0;
  std::uint64_t bytes_ = 0;
};

/// Digest of a file, read in pieces. Throws Error(input) if it cannot be read.
std::string sha256_of(const std::filesystem::path& file);

}  // namespace faba
