#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "study/data/flow_source.h"

namespace faba {

/// How far a flow is from the true one, over the pixels where that is known (Barron et al. 1994).
struct FlowError {
  double endpoint_px = 0;  ///< mean distance
  double angular_deg = 0;  ///< mean angle between (u, v, 1) of both
  double known = 0;        ///< fraction of the pixels where the true flow is known, 0..1
};

/// The flow from one picture to another.
struct PairFlow {
  Flow flow;
  std::string method;                ///< flow part and its parameters, as JSON
  std::optional<FlowEffort> effort;  ///< where the method has it
  Vec2 mean_px;                      ///< image frame, y down
  double mean_speed_px = 0;
  double largest_px = 0;           ///< greatest speed
  std::optional<FlowError> error;  ///< where the true flow was given
  std::vector<std::string> notes;
};

/// The flows of a video.
struct VideoFlow {
  int width = 0, height = 0;  ///< of the flows, px
  std::string method;         ///< flow part and its parameters, as JSON
  std::uint64_t pairs = 0;    ///< of frames
  double seconds = 0;         ///< from the first frame to the last
  double mean_speed_px = 0;   ///< per pair
  std::vector<std::string> notes;
};

/// The flow from picture file `a` to `b`, and its error when `truth`, a .flo file, is not empty. Throws
/// Error(input) for files that cannot be read and for pictures of different size or kind.
PairFlow measure_flow(const std::filesystem::path& a, const std::filesystem::path& b,
                      const FlowRegistry::PartType& method, const std::filesystem::path& truth, Pool& pool);

/// Reads all flows of a source; `take` is called with each of them. `name` stands for the source in messages.
/// Throws what the source throws, and Error(input) when there is no pair of frames.
VideoFlow measure_flow(FlowSource& source, const std::string& name,
                       const std::function<void(const FlowPair&)>& take);

}  // namespace faba
