#pragma once
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "core/toml.h"
#include "server/workspace.h"
#include "study/pages/tracks/track_folder.h"

namespace faba {

/// The tracked videos of a workspace: folders below runs/ and experiments/NAME/tracks/ that `faba track
/// --result` has written, with the edits of the pages. Keeps the last three in memory. Thread-safe.
class TrackResults {
 public:
  explicit TrackResults(const Workspace& workspace) : workspace_(workspace) {}

  /// [{"folder", "video", "tracks", "quality"}], newest first.
  Json list() const;
  /// A new folder for the result of a video: experiments/NAME/tracks/VIDEO-STAMP for a video of an
  /// experiment, otherwise runs/tracks-VIDEO-STAMP. The folder above it is created.
  std::string new_folder(const std::string& video) const;

  /// "summary" of the measured tracks, "edits" with "revision", and all "tracks" after manual edits with
  /// their features and fate. "video": null if it is not in the workspace.
  Json read(const std::string& folder);
  /// Detections of all tracks of read(), in their order: frame (uint32), time in s, x and y in px (float32).
  std::string points(const std::string& folder);
  /// Replaces the edits and answers as read(), without summary. Throws Error(usage) for invalid edits, and if
  /// another page has changed them: `revision` in `asked` must be the present one.
  Json change(const std::string& folder, const Json& asked);
  /// Motion of the used tracks, as `faba track --edits --json`.
  Json edited(const std::string& folder);
  /// Writes the used tracks and their features into the folder. {"tracks", "features"}: names of the files.
  Json write(const std::string& folder);

 private:
  struct Loaded {
    std::string key, revision;
    TrackFolder folder;
    EditedFolder edited;
  };
  std::filesystem::path path(const std::string& folder) const;
  std::shared_ptr<const Loaded> load(const std::string& folder);
  Json tracks_json(const Loaded& r) const;

  const Workspace& workspace_;
  std::mutex mutex_;
  std::list<std::shared_ptr<const Loaded>> loaded_;
};

}  // namespace faba
