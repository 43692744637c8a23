#include "study/sweep/study_directory.h"

#include <fmt/format.h>

#include <optional>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char *kMarker = "incomplete", *kStudy = "study.json", *kResults = "results.jsonl";

// The hash of the study in a directory.
std::optional<std::string> hash_of_study_in(const fs::path& dir) {
  if (!fs::is_regular_file(dir / kStudy)) return {};
  const auto j = nlohmann::json::parse(read_file(dir / kStudy), nullptr, false);
  if (!j.is_object()) return {};
  for (const char* key : {"study_hash", "fingerprint"})  // name in an earlier version
    if (j.contains(key) && j[key].is_string()) return j[key].get<std::string>();
  return {};
}

// Output files of all kinds of studies.
constexpr const char* kWritten[] = {"identify.json",    "identify.html",   "best.toml",  "background.png",
                                    "controllers.json", "controllers.csv", "report.html"};

}  // namespace

bool holds_complete_study(const fs::path& dir, const std::string& study_hash) {
  return hash_of_study_in(dir) == study_hash && !fs::exists(dir / kMarker);
}

StudyDirectory::~StudyDirectory() {
  if (!new_ || complete_ || !results_ || !results_->empty()) return;
  results_.reset();
  lock_.complete();
  std::error_code ignored;
  for (const char* name : {kResults, kStudy}) fs::remove(dir_ / name, ignored);
  fs::remove(dir_, ignored);  // fails when it contains other files
}

StudyDirectory::StudyDirectory(const fs::path& dir, const std::string& study_hash,
                               const std::string& resume_command, bool force)
    : dir_(dir), study_hash_(study_hash) {
  std::error_code ec;
  if (fs::exists(fs::symlink_status(dir)) && !fs::is_directory(dir))
    throw Error(Errc::usage, dir.string(), "exists and is not a directory; choose another --out");
  new_ = !fs::is_directory(dir);
  if (new_) fs::create_directories(dir, ec);
  if (!fs::is_directory(dir))
    throw Error(Errc::internal, dir.string(),
                fmt::format("the directory cannot be created: {}; choose another --out", ec.message()));
  const auto existing = hash_of_study_in(dir);
  if (!existing && !fs::is_empty(dir, ec))
    throw Error(Errc::usage, dir.string(), "contains other files and no study; choose another --out");
  const bool same = existing == study_hash;
  if (existing && !same && !force)
    throw Error(Errc::usage, dir.string(),
                "contains a different study; choose another --out, or --force to replace it");
  if (same && !fs::exists(dir / kMarker) && !force)
    throw Error(Errc::usage, dir.string(),
                "the study is already complete; choose another --out, or --force to write its pages again");
  lock_ = FileLock(dir / kMarker, dir,
                   fmt::format("This study is not complete. Resume it with: {}\n", resume_command));
  if (!same) {
    fs::remove(dir / kResults, ec);
    if (existing)
      for (const char* name : kWritten) fs::remove(dir / name, ec);
    write_file(dir / kStudy,
               nlohmann::ordered_json{{"study_hash", study_hash}, {"version", FABA_VERSION}}.dump(2) + "\n");
  }
  results_ = std::make_unique<ResultStore>(dir / kResults);
}

void StudyDirectory::complete(const nlohmann::ordered_json& more) {
  nlohmann::ordered_json j{{"study_hash", study_hash_}, {"version", FABA_VERSION}};
  j.update(more);
  write_file(dir_ / kStudy, j.dump(2) + "\n");
  lock_.complete();
  complete_ = true;
}

void check_merge(const std::vector<fs::path>& dirs, const std::string& study_hash) {
  for (const fs::path& other : dirs) {
    if (!fs::exists(other))
      throw Error(Errc::input, other.string(), "directory not found; check the names after --merge");
    const auto existing = hash_of_study_in(other);
    if (!existing)
      throw Error(Errc::input, other.string(), "contains no study; check the names after --merge");
    if (*existing != study_hash) throw Error(Errc::usage, other.string(), "contains a different study");
  }
}

void StudyDirectory::merge(const std::vector<fs::path>& dirs) {
  check_merge(dirs, study_hash_);
  for (const fs::path& other : dirs) {
    if (fs::weakly_canonical(other) != fs::weakly_canonical(dir_) && fs::exists(other / kResults))
      results_->merge(other / kResults);
  }
}

}  // namespace faba
