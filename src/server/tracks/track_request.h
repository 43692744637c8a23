#pragma once
#include <string>
#include <vector>

#include "core/toml.h"
#include "server/workspace.h"
#include "study/tracks/track_options.h"

namespace faba {

/// The settings of a tracking that a page sends: `file`, and those of the options of `faba track` that it
/// overrides, such as "size", "threshold", "polarity", "reach"; see web/protocol.md.
struct TrackRequest {
  std::string file;                ///< relative to the workspace
  TrackOptions options;            ///< `options.video` is absolute
  std::vector<std::string> words;  ///< the same settings as options of `faba track`
};

/// Throws Error(Errc::usage) with the key of a value that is not permitted.
TrackRequest track_request(const Workspace& workspace, const Json& asked);

}  // namespace faba
