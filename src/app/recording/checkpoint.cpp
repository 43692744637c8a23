#include "app/recording/checkpoint.h"

#include <zlib.h>

#include <cstring>

#include "core/file.h"

namespace faba {
namespace {

constexpr char kMagic[] = "faba checkpoint 1\n";
constexpr std::size_t kMagicSize = sizeof kMagic - 1;

std::uint32_t checksum(std::string_view bytes, std::uint32_t before = 0) {
  return std::uint32_t(crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::string_view text_of(const Archive& a) {
  return {reinterpret_cast<const char*>(a.bytes().data()), a.bytes().size()};
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash,
                      const Archive& content) {
  // As an Archive of the hash and the bytes, without a copy of the bytes: they are most of the memory of a
  // run.
  Archive head;
  std::string hash = scenario_hash;
  std::uint64_t length = content.bytes().size();
  head& hash& length;
  const std::uint32_t sum = checksum(text_of(content), checksum(text_of(head)));
  const std::string_view sum_bytes(reinterpret_cast<const char*>(&sum), sizeof sum);
  write_file(file, {{kMagic, kMagicSize}, sum_bytes, text_of(head), text_of(content)});
}

Archive read_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash) {
  const std::string in = read_file(file);
  const auto fail = [&](const char* what) { throw Error(Errc::input, file.string(), what); };
  if (in.size() < kMagicSize + 4 || in.compare(0, kMagicSize, kMagic) != 0)
    fail("is not a checkpoint of this version of faba");
  std::uint32_t sum = 0;
  std::memcpy(&sum, in.data() + kMagicSize, 4);
  if (sum != checksum(std::string_view(in).substr(kMagicSize + 4)))
    fail("is corrupt (wrong checksum); run the scenario again");
  Archive body(std::vector<std::uint8_t>(in.begin() + long(kMagicSize) + 4, in.end()));
  std::string hash;
  std::vector<std::uint8_t> bytes;
  body& hash& bytes;
  if (hash != scenario_hash) fail("belongs to another scenario");
  return Archive(std::move(bytes));
}

}  // namespace faba
