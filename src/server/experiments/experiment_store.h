#pragma once
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

#include "core/toml.h"
#include "server/workspace.h"
#include "study/experiment/experiment.h"

namespace faba {

/// A [[video]] of an experiment file.
struct VideoEntry {
  std::size_t position = 0;  ///< in the list
  Json values;
};

/// The experiments of a workspace: the folders below experiments/ with an experiment file. Several pages may
/// change one experiment. Thread-safe.
class ExperimentStore {
 public:
  /// `changed` is called with the name of an experiment after each change.
  ExperimentStore(const Workspace& workspace, std::function<void(const std::string& name)> changed)
      : workspace_(workspace), changed_(std::move(changed)) {}

  /// [{"name", "title", "drops", "videos"} or {"name", "error"}], newest first.
  Json list() const;
  /// Creates an experiment. Returns its name: the title as a folder name, with a number if it is used.
  std::string create(const std::string& title);
  /// {"name", "revision", "experiment"}. Throws Error(input) if the experiment is not found, Error(usage) for
  /// an invalid file.
  Json read(const std::string& name) const;
  /// Applies the `changes` of a request. The answer of read(), or {"conflicts": [{"path", "now"}]} with it if
  /// a change was refused. Throws Error(usage) if the changed experiment would be invalid.
  Json change(const std::string& name, const Json& asked);
  /// Adds a video. `file`: relative to the folder of the experiment, or absolute; `drop`: its drop, ignored
  /// if the experiment has no such drop.
  void add_video(const std::string& name, const std::string& file, const std::string& drop);
  /// Adds a recording of the bench. Its drop is added if the experiment does not have it; `polarity` of its
  /// cells (+1 north-seeking, -1 south-seeking, 0 not known) is noted unless the drop states one.
  void add_recording(const std::string& name, Json video, int polarity);
  /// The entry of a video. Throws Error(input) if the experiment has no such video.
  VideoEntry video(const std::string& name, const std::string& file) const;
  /// Removes the entry of a video, if it has one. The file stays.
  void remove_video(const std::string& name, const std::string& file);
  /// Adds an entry that was removed, at its former position, unless the experiment has the video again.
  void restore_video(const std::string& name, const VideoEntry& entry);
  /// Names of the experiments that use a file as a video or for the noise, without the entry of the
  /// experiment `but` for it. Experiments with an invalid file are not searched.
  std::vector<std::string> users_of(const std::filesystem::path& file, const std::string& but) const;

  /// Its folder. Throws Error(input) if there is no such experiment.
  std::filesystem::path folder(const std::string& name) const;
  /// The folder of its imported videos, created if it is missing. Throws Error(usage) if a link leads out of
  /// the workspace.
  std::filesystem::path video_folder(const std::string& name) const;

 private:
  Json read_locked(const std::string& name) const;
  Document document(const std::string& name) const;
  void write_locked(const std::string& name, Document d);
  void check_videos(const std::filesystem::path& file, const Experiment& e) const;

  const Workspace& workspace_;
  std::function<void(const std::string& name)> changed_;
  mutable std::mutex mutex_;
};

/// A name for files and folders: letters, digits, dots, dashes and underscores, without a leading dot or
/// dash; other characters become dashes, also those of Unicode that are invisible or change the direction of
/// text. Empty if nothing is left.
std::string safe_name(const std::string& text);

}  // namespace faba
