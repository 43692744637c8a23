#include "app/recording/checkpoint.h"

#include <zlib.h>

#include <cstring>

#include "core/file.h"

namespace faba {
namespace {

constexpr char kMagic[] = "faba checkpoint 1\n";
constexpr std::size_t kMagicSize = sizeof kMagic - 1;

std::uint32_t checksum(const std::string& bytes, std::size_t from) {
  return std::uint32_t(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()) + from, bytes.size() - from));
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash,
                      const Archive& content) {
  Archive body;
  std::string hash = scenario_hash;
  std::vector<std::uint8_t> bytes = content.bytes();
  body& hash& bytes;
  std::string out(kMagic, kMagicSize);
  out.append(4, '\0');
  out.append(reinterpret_cast<const char*>(body.bytes().data()), body.bytes().size());
  const std::uint32_t sum = checksum(out, kMagicSize + 4);
  std::memcpy(out.data() + kMagicSize, &sum, 4);
  write_file(file, out);
}

Archive read_checkpoint(const std::filesystem::path& file, const std::string& scenario_hash) {
  const std::string in = read_file(file);
  const auto fail = [&](const char* what) { throw Error(Errc::input, file.string(), what); };
  if (in.size() < kMagicSize + 4 || in.compare(0, kMagicSize, kMagic) != 0)
    fail("is not a checkpoint of this version of faba");
  std::uint32_t sum = 0;
  std::memcpy(&sum, in.data() + kMagicSize, 4);
  if (sum != checksum(in, kMagicSize + 4)) fail("is corrupt (wrong checksum); run the scenario again");
  Archive body(std::vector<std::uint8_t>(in.begin() + long(kMagicSize) + 4, in.end()));
  std::string hash;
  std::vector<std::uint8_t> bytes;
  body& hash& bytes;
  if (hash != scenario_hash) fail("belongs to another scenario");
  return Archive(std::move(bytes));
}

}  // namespace faba
