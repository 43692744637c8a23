#include "app/scenario/file_kind.h"

#include <array>
#include <optional>

namespace faba {
namespace {

// In the order of FileKind.
constexpr std::array kMessages = {
    "is a scenario; run it with `faba run`",
    "is a coil system file; use `faba field`, or name it in the table [field] of a scenario",
    "is a study for `faba identify`",
    "is a study for `faba activity`",
    "is a study for `faba compare-controllers`",
    "is a study for `faba moment`",
    "is a file for `faba calibrate`",
    "is a benchmark for `faba benchmark-control`"};

}  // namespace

std::optional<FileKind> file_kind(const Node& root) {
  const auto is_list = [&](const char* key) { return root.has(key) && root.child(key).json->is_array(); };
  if (is_list("swarm")) return FileKind::scenario;
  if (is_list("case")) return FileKind::control_benchmark;
  if (is_list("coil")) return FileKind::coil_system;
  if (root.has("scene") && root.child("scene").json->is_string()) return FileKind::controller_study;
  if (root.has("study") && root.child("study").json->is_string()) return FileKind::calibration_study;
  if (is_list("video") && !root.child("video").json->empty() &&
      root.child("video").item(0).json->is_object() && root.child("video").item(0).has("reversals"))
    return FileKind::moment_study;
  // Both studies of videos may omit most keys; only identification has candidates.
  if (is_list("video")) return is_list("model") ? FileKind::identify_study : FileKind::activity_study;
  return {};
}

void require_kind(const Node& root, FileKind wanted) {
  const std::optional<FileKind> kind = file_kind(root);
  if (!kind || *kind == wanted) return;
  // The keys that distinguish a study for identification or of moments may be missing; its reader asks for
  // them.
  if (*kind == FileKind::activity_study &&
      (wanted == FileKind::identify_study || wanted == FileKind::moment_study))
    return;
  root.fail(kMessages.at(std::size_t(*kind)));
}

}  // namespace faba
