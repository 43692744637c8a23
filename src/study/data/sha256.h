#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // EVP_MD_CTX of OpenSSL

namespace faba {

/// SHA-256 (FIPS 180-4): identifies the content of files; `sha256sum` prints the same digits.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// The digest of everything added, 64 hexadecimal digits. Nothing can be added after it.
  std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// Digest of a file, read in pieces. Throws Error(input) if it cannot be read.
std::string sha256_of(const std::filesystem::path& file);

}  // namespace faba
