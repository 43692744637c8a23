#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/toml.h"

namespace faba::cli {

/// A scenario file, the values that options change, and the directory of the run.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> set;  ///< "path=value"
  std::optional<std::string> seed, duration;
  unsigned threads = 0;
  std::filesystem::path out;
  std::filesystem::path from_video;
  bool as_seen = false, force = false;
};

/// The scenario file with the changes of the options, and a title. `drop_note`: the drop of --from-video.
Document read_scene(const SceneOptions& v, std::string* drop_note = nullptr);

/// Throws Error(usage) if an input file is in the directory `out` given by the user: a run must not replace
/// its input.
void reject_input_in_out(const SceneOptions& v);

}  // namespace faba::cli
