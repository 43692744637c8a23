#pragma once
#include <string>
#include <vector>

#include "core/toml.h"

namespace faba {

/// A change of one value of an experiment by a page. The path has keys of tables, and the identity of an item
/// of a list: the `name` of a drop, the `file` of a video.
struct ExperimentChange {
  std::vector<std::string> path;  ///< {"video", "videos/a.mp4", "exposure"}
  Json from;                      ///< value that the page has seen; null: none
  Json to;                        ///< new value; null removes the value or the item
};

/// Reads the list of changes in a request. Throws Error(usage).
std::vector<ExperimentChange> changes_of(const Json& asked);

/// Why changes were refused: the present values at their paths.
struct ChangeConflict {
  std::vector<std::string> path;
  Json now;
};

/// Applies all changes to an experiment document, or none. A change whose value has been changed by another
/// page since is a conflict, unless both made the same change. Throws Error(usage) for a path that an
/// experiment cannot have.
std::vector<ChangeConflict> apply_changes(Json& experiment, const std::vector<ExperimentChange>& changes);

}  // namespace faba
