#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "study/data/flow_source.h"
#include "study/quality/quality.h"

namespace faba {

/// Error of a flow, over the pixels where the true flow is known (Barron et al. 1994).
struct FlowError {
  double endpoint_px = 0;  ///< mean endpoint error
  double angular_deg = 0;  ///< mean angle between (u, v, 1) and (u_true, v_true, 1)
  double known = 0;        ///< fraction of the pixels where the true flow is known, 0..1
};

/// The flow from one picture to another.
struct PairFlow {
  Flow flow;
  VideoScale scale;                  ///< of the first picture
  std::string method;                ///< flow part and its parameters, as JSON
  std::optional<FlowEffort> effort;  ///< iterations, where the method reports them
  Vec2 mean_px;                      ///< image frame, y down
  double mean_speed_px = 0;
  double largest_px = 0;           ///< largest speed
  std::optional<FlowError> error;  ///< when the true flow was given
  /// Mean square difference of the pictures after the second one was moved back along the flow, over that
  /// before; the flow explains the difference when it is small. Empty for equal pictures.
  std::optional<double> unexplained;
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

/// The flows of a video.
struct VideoFlow {
  int width = 0, height = 0;          ///< of the flows, px
  VideoScale scale;                   ///< of the video
  std::string method;                 ///< flow part and its parameters, as JSON
  std::uint64_t pairs = 0;            ///< number of pairs of frames
  double seconds = 0;                 ///< duration from the first frame to the last
  bool timed = true;                  ///< false: no frame rate is stated, and `seconds` is a number of frames
  double mean_speed_px = 0;           ///< per pair
  std::optional<double> unexplained;  ///< see PairFlow, of some pairs; empty for flows from a file
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

/// The flow from picture file `a` to `b`, and its error when `truth`, a .flo file, is not empty. Throws
/// Error(input) for files that cannot be read and for pictures of different size or depth.
PairFlow measure_flow(const std::filesystem::path& a, const std::filesystem::path& b,
                      const FlowRegistry::PartType& method, const std::filesystem::path& truth, Pool& pool);

/// Reads all flows of a source; `take` is called for each of them. Throws the errors of the source.
VideoFlow measure_flow(FlowSource& source, const std::function<void(const FlowPair&)>& take);

}  // namespace faba
