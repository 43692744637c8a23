#include "study/sweep/round_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "core/archive.h"
#include "core/error.h"
#include "core/file.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kRoundKind = "faba round 1";

std::uint32_t checksum_of_text(const std::string& text) {
  return std::uint32_t(crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

// One description of writing and reading. `checksum`: of the description.
void archive_round(Archive& a, std::string& kind, std::string& study_hash, PlannedRound& r,
                   std::uint32_t& checksum) {
  a& kind& study_hash& r.first& r.size& checksum& r.description;
}

fs::path round_path(const fs::path& dir, std::uint64_t first) {
  return dir / study_files::kRounds / fmt::format("{:010}.round", first);
}

PlannedRound read_round(const fs::path& file, const std::string& study_hash) {
  const std::string bytes = read_file(file);
  Archive a(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  std::string kind, hash;
  PlannedRound r;
  std::uint32_t checksum = 0;
  try {
    archive_round(a, kind, hash, r, checksum);
  } catch (const Error&) {
    kind.clear();
  }
  if (kind != kRoundKind || checksum != checksum_of_text(r.description))
    throw Error(Errc::input, file.string(),
                "is damaged; delete it and run `faba study collect` to write it again");
  if (hash != study_hash) throw Error(Errc::usage, file.string(), "belongs to a different study");
  return r;
}

}  // namespace

void plan_round(const fs::path& dir, const std::string& study_hash, const PlannedRound& round) {
  const fs::path file = round_path(dir, round.first);
  fs::create_directories(file.parent_path());
  fs::create_directories(dir / study_files::kResults);
  Archive a;
  std::string kind = kRoundKind, hash = study_hash;
  PlannedRound r = round;
  std::uint32_t checksum = checksum_of_text(r.description);
  archive_round(a, kind, hash, r, checksum);
  const std::string_view bytes(reinterpret_cast<const char*>(a.bytes().data()), a.bytes().size());
  if (!fs::exists(file) || read_file(file) != bytes) write_file(file, bytes);
}

std::vector<PlannedRound> planned_rounds(const fs::path& dir, const std::string& study_hash) {
  std::vector<PlannedRound> rounds;
  std::error_code missing;
  for (const auto& e : fs::directory_iterator(dir / study_files::kRounds, missing))
    if (e.path().extension() == ".round") rounds.push_back(read_round(e.path(), study_hash));
  std::sort(rounds.begin(), rounds.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return rounds;
}

PlannedRound planned_round(const fs::path& dir, const std::string& study_hash, std::uint64_t number) {
  std::uint64_t planned = 0;
  for (PlannedRound& r : planned_rounds(dir, study_hash)) {
    if (r.contains(number)) return std::move(r);
    planned = r.first + r.size - 1;
  }
  if (planned == 0)
    throw Error(Errc::usage, dir.string(), "has no planned tasks; run `faba study plan` with the study file");
  throw Error(
      Errc::usage, "--tasks",
      fmt::format("task {} is not planned; {} has tasks 1 to {}; run `faba study collect` to plan the "
                  "next round",
                  number, dir.string(), planned));
}

}  // namespace faba
