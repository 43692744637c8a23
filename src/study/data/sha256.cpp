#include "study/data/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::size_t kPiece = 1u << 20;  // bytes read at a time

void require(int result) {
  if (result != 1) throw Error(Errc::internal, "SHA-256", "libcrypto could not compute a digest");
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  // The configuration file of OpenSSL has nothing for a digest, and takes a millisecond to read.
  OPENSSL_init_crypto(OPENSSL_INIT_NO_LOAD_CONFIG, nullptr);
  require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

void Sha256::add(std::string_view bytes) {
  require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest{};
  require(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
  std::string out;
  for (const unsigned char byte : digest) out += fmt::format("{:02x}", byte);
  return out;
}

std::string sha256_of(const std::filesystem::path& file) {
  std::error_code ec;
  if (std::filesystem::status(file, ec).type() == std::filesystem::file_type::not_found)
    throw Error(Errc::input, file.string(), "file not found; check the name");
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw Error(Errc::input, file.string(), "cannot be read");
  Sha256 sum;
  std::vector<char> piece(kPiece);
  while (in.read(piece.data(), std::streamsize(piece.size())) || in.gcount() > 0)
    sum.add({piece.data(), std::size_t(in.gcount())});
  return sum.hex();
}

}  // namespace faba
