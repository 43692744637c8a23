#include "study/sweep/study_directory.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "study/sweep/program_version.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;
using namespace study_files;

// Everything that a study writes into its directory, apart from study.json and the marker.
constexpr const char* kWritten[] = {"identify.json",    "identify.html",
                                    "best.toml",        "background.png",
                                    "calibration.json", "calibration.html",
                                    "controllers.json", "controllers.csv",
                                    "report.html",      kResults,
                                    "results.jsonl",    "activity.json",
                                    "activity.csv",     "activity.html",
                                    "tracks.json",      kRounds,
                                    kMeasured,          kJobs,
                                    kAttempts,          kVideos};

// study.json; null when it does not exist or is not a study.
OrderedJson study_in(const fs::path& dir) {
  if (!fs::is_regular_file(dir / kStudy)) return nullptr;
  OrderedJson j = OrderedJson::parse(read_file(dir / kStudy), nullptr, false);
  if (!j.is_object()) return nullptr;
  return j;
}

std::optional<std::string> hash_of_study_in(const fs::path& dir) {
  const OrderedJson j = study_in(dir);
  for (const char* key : {"study_hash", "fingerprint"})  // name in an earlier version
    if (j.is_object() && j.contains(key) && j[key].is_string()) return j[key].get<std::string>();
  return {};
}

// The path of the study file is stored as given, relative to the directory and absolute, because workers can
// have another working directory and another mount point. Without a study file the same holds for the working
// directory.
OrderedJson study_json(const fs::path& dir, const std::string& study_hash, const StudySource& s) {
  OrderedJson j{{"study_hash", study_hash}, {"version", program_version()}};
  if (s.empty()) return j;
  const bool with_file = !s.file.empty();
  const fs::path path = fs::absolute(with_file ? s.file : fs::path(".")).lexically_normal();
  const std::string name = with_file ? "file" : "folder";
  j["command"] = s.verb;
  if (with_file) j[name] = s.file.string();
  j[name + "_from_here"] = path.lexically_relative(fs::absolute(dir).lexically_normal()).string();
  j[name + "_absolute"] = path.string();
  j["inputs"] = s.inputs;
  j["options"] = s.options;
  return j;
}

// The study file, or the working directory, where it is here.
fs::path found_here(const fs::path& dir, const OrderedJson& j, const std::string& name) {
  const fs::path given = j.value(name, ""), here = dir / j.value(name + "_from_here", ""),
                 absolute = j.value(name + "_absolute", "");
  std::error_code ec;
  for (const fs::path& path : {given, here, absolute})
    if (name == "file" ? fs::is_regular_file(path, ec) : fs::is_directory(path, ec)) return path;
  throw Error(
      Errc::input, dir.string(),
      fmt::format("the {} of the study is not found, neither at {} nor at {}; it must be in the folder "
                  "that all machines share",
                  name, here.string(), absolute.string()));
}

}  // namespace

StoredStudy stored_study(const fs::path& dir) {
  const OrderedJson j = study_in(dir);
  if (j.is_null() || !j.contains("command"))
    throw Error(Errc::input, dir.string(),
                "contains no study; give the directory that `faba study plan` or the command of the study "
                "has written");
  StoredStudy s{j.value("study_hash", ""), j.value("version", ""), {}};
  if (s.version != program_version())
    throw Error(
        Errc::usage, dir.string(),
        fmt::format("the study was planned by faba {}, this is faba {}; use one program for all parts "
                    "of a study",
                    s.version, program_version()));
  const bool with_file = j.contains("file");
  const fs::path found = found_here(dir, j, with_file ? "file" : "folder");
  s.source = {j["command"].get<std::string>(), with_file ? found : "",
              j.value("inputs", std::vector<std::string>()), j.value("options", std::vector<std::string>()),
              with_file ? "" : found};
  return s;
}

bool holds_complete_study(const fs::path& dir, const std::string& study_hash) {
  return hash_of_study_in(dir) == study_hash && !fs::exists(dir / kMarker);
}

std::string version_of_study(const fs::path& dir) {
  const OrderedJson j = study_in(dir);
  return j.is_object() ? j.value("version", "") : "";
}

StudyDirectory::~StudyDirectory() {
  if (!new_ || complete_ || !results_ || !results_->empty()) return;
  for (const char* name : {kRounds, kResults, kJobs})
    if (fs::exists(dir_ / name)) return;
  results_.reset();
  lock_.complete();
  std::error_code ignored;
  fs::remove(dir_ / kStudy, ignored);
  fs::remove_all(dir_ / kMeasured, ignored);
  fs::remove(dir_, ignored);  // fails when it contains other files
}

StudyDirectory::StudyDirectory(const fs::path& dir, const std::string& study_hash,
                               const std::string& resume_command, bool force, StudySource source)
    : dir_(dir), study_hash_(study_hash), source_(std::move(source)) {
  std::error_code ec;
  if (fs::exists(fs::symlink_status(dir)) && !fs::is_directory(dir))
    throw Error(Errc::usage, dir.string(), "exists and is not a directory; choose another directory");
  new_ = !fs::is_directory(dir);
  if (new_) fs::create_directories(dir, ec);
  if (!fs::is_directory(dir))
    throw Error(Errc::internal, dir.string(),
                fmt::format("the directory cannot be created: {}; choose another directory", ec.message()));
  const auto existing = hash_of_study_in(dir);
  if (!existing && !fs::is_empty(dir, ec))
    throw Error(Errc::usage, dir.string(), "contains other files and no study; choose another directory");
  const bool same = existing == study_hash && version_of_study(dir) == program_version();
  if (existing == study_hash && !same && !force)
    throw Error(
        Errc::usage, dir.string(),
        fmt::format(
            "contains results of this study by faba {}, this is faba {}; continue it with that program, "
            "choose another directory, or --force to compute it again",
            version_of_study(dir), program_version()));
  if (existing && !same && !force)
    throw Error(Errc::usage, dir.string(),
                "contains a different study; choose another directory, or --force to replace it");
  if (same && !fs::exists(dir / kMarker) && !force)
    throw Error(
        Errc::usage, dir.string(),
        "the study is already complete; choose another directory, or --force to write its pages again");
  lock_ =
      FileLock(dir / kMarker, dir,
               fmt::format("This study is not complete. Resume it with: {}\n", resume_command), Errc::busy);
  if (existing && !same)
    for (const char* name : kWritten) fs::remove_all(dir / name, ec);
  if (!same || !source_.empty())
    write_file(dir / kStudy, study_json(dir, study_hash, source_).dump(2) + "\n");
  results_ = std::make_unique<ResultStore>(dir / kResults, study_hash);
}

void StudyDirectory::complete(const OrderedJson& more) {
  OrderedJson j = study_json(dir_, study_hash_, source_);
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
  for (const fs::path& other : dirs)
    if (fs::weakly_canonical(other) != fs::weakly_canonical(dir_)) results_->merge(other / kResults);
}

}  // namespace faba
