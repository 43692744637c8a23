#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/toml.h"

namespace faba::cli {

/// A scenario file, what options change in it, and where its run goes.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> set;  ///< "path=value"
  std::optional<std::string> seed, duration;
  unsigned threads = 0;
  std::filesystem::path out;
  std::filesystem::path from_video;
  bool as_seen = false, force = false;
};

/// The scenario file with what the options change in it, and a title.
Document read_scene(const SceneOptions& v);

/// Throws Error(usage) when `out`, given by the user, is where an input lies: what a run is made from is not
/// to be replaced by it.
void refuse_own_input(const SceneOptions& v);

}  // namespace faba::cli
