#include "app/recording/run_directory.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba {
namespace {

using namespace run_files;
constexpr const char* kRunFiles[] = {
    kMarker,         kCheckpoint,      kScenario,   kManifest,        "series.csv", "tracks.h5",
    "tracks.h5.new", "video.mp4.part", "video.mp4", "video.avi.part", "video.avi",  "flow.h5",
    "report.html",   kRoCrate,         kCommands,   kCoilsLog,        "latency.csv"};

bool holds_run(const std::filesystem::path& dir) {
  std::error_code ec;
  const auto has = [&](const char* name) { return std::filesystem::is_regular_file(dir / name, ec); };
  return RunLock::marks(dir) || (has(kManifest) && has(kScenario));
}

// Creates the directory if necessary; returns whether it is new. All checks of an existing directory are done
// here, before anything in it is removed.
bool make_directory(const std::filesystem::path& dir, bool force) {
  std::error_code of_parent, ec;
  if (dir.has_parent_path()) std::filesystem::create_directories(dir.parent_path(), of_parent);
  if (std::filesystem::create_directory(dir, ec)) return true;
  if (!std::filesystem::is_directory(dir)) {
    if (std::filesystem::exists(std::filesystem::symlink_status(dir)))
      throw Error(Errc::usage, dir.string(), "exists and is not a directory");
    throw Error(
        Errc::internal, dir.string(),
        fmt::format("cannot be created: {}; choose another --out", (of_parent ? of_parent : ec).message()));
  }
  if (std::filesystem::is_empty(dir, ec)) return false;
  if (!holds_run(dir))
    throw Error(Errc::usage, dir.string(), "has files that do not belong to a run; choose another --out");
  if (!force)
    throw Error(
        Errc::usage, dir.string(),
        RunLock::marks(dir) && std::filesystem::is_regular_file(dir / kCheckpoint, ec)
            ? "contains a run that is not complete; continue it with `faba resume`, or choose another --out, "
              "or --force to replace it"
            : "already contains a run; choose another --out, or --force to replace it");
  for (const char* name : kRunFiles)
    if (std::filesystem::is_directory(dir / name, ec))
      throw Error(Errc::usage, (dir / name).string(),
                  "is a directory, but the run writes a file of this name; choose another --out");
  return false;
}

// Creates the first of `base`, `base`-2, `base`-3 ... that does not exist.
std::filesystem::path make_numbered(const std::filesystem::path& base) {
  for (int i = 1;; ++i) {
    std::filesystem::path dir = i == 1 ? base.string() : fmt::format("{}-{}", base.string(), i);
    if (std::filesystem::exists(std::filesystem::symlink_status(dir))) continue;
    try {
      if (make_directory(dir, false)) return dir;
    } catch (const Error& e) {
      if (e.code() != Errc::usage) throw;  // another process created it first
    }
  }
}

}  // namespace

RunDirectory RunDirectory::make(const Options& o) {
  RunDirectory d;
  if (o.numbered) {
    d.path_ = make_numbered(o.out);
  } else {
    d.path_ = o.out;
    make_directory(d.path_, o.force);
  }
  d.lock_ = RunLock(d.path_, o.program);
  std::error_code ec;
  // Another process may have written a run to the directory in the meantime.
  if (!o.force && std::filesystem::exists(d.path_ / kManifest, ec)) {
    d.lock_.complete();
    throw Error(Errc::usage, d.path_.string(),
                "already contains a run; choose another --out, or --force to replace it");
  }
  for (const char* name : kRunFiles)  // other files are kept
    if (std::string_view(name) != kMarker) std::filesystem::remove(d.path_ / name, ec);
  return d;
}

void RunDirectory::complete() {
  std::error_code ec;
  std::filesystem::remove(path_ / kCheckpoint, ec);
  lock_.complete();
}

}  // namespace faba
