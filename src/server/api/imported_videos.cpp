#include "server/api/imported_videos.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& experiment) { return "experiments/" + experiment; }

// A file in the folder videos/ itself; links and other folders belong to the user.
bool is_imported(const fs::path& folder, const std::string& file) {
  std::error_code ec;
  return fs::path(file).parent_path() == "videos" &&
         fs::is_regular_file(fs::symlink_status(folder / file, ec));
}

// A job of the experiment may read all of its videos.
void check_unused(const LabServices& lab, const std::string& experiment, const std::string& file) {
  for (const Job& j : lab.jobs.jobs())
    if (job_uses(j, folder_of(experiment)))
      throw Error(
          Errc::usage, file,
          fmt::format("the job \"{}\" uses this experiment; wait until it ends or cancel it", j.title));
}

}  // namespace

Json describe_imported_video(const LabServices& lab, const std::string& experiment, const std::string& file) {
  (void)lab.experiments.video(experiment, file);
  const fs::path folder = lab.experiments.folder(experiment);
  const bool imported = is_imported(folder, file);
  Json j = {{"file", file}, {"imported", imported}, {"bytes", 0}, {"used_by", Json::array()}};
  if (!imported) return j;
  j["bytes"] = bytes_of(folder / file);
  j["used_by"] = lab.experiments.users_of(folder / file, experiment);
  return j;
}

Trash::Item remove_imported_video(const LabServices& lab, const std::string& experiment,
                                  const std::string& file) {
  const VideoEntry entry = lab.experiments.video(experiment, file);
  const Json about = describe_imported_video(lab, experiment, file);
  if (!about["imported"])
    throw Error(Errc::usage, file,
                "is not in the folder videos/ of the experiment and is not deleted; remove the entry only");
  if (!about["used_by"].empty())
    throw Error(Errc::usage, file,
                fmt::format("is used by the experiment {}; remove it there first, or remove the entry only",
                            fmt::join(about["used_by"].get<std::vector<std::string>>(), ", ")));
  check_unused(lab, experiment, file);
  ExperimentStore& store = lab.experiments;
  Trash::Item item = lab.trash.take(folder_of(experiment) + "/" + file, {},
                                    [&store, experiment, entry] { store.restore_video(experiment, entry); });
  try {
    store.remove_video(experiment, file);
  } catch (const Error&) {
    lab.trash.undo(item.id);
    throw;
  }
  return item;
}

}  // namespace faba
