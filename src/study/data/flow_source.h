#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/data/frame_inspector.h"
#include "study/data/kept_flows.h"
#include "study/data/video_scale.h"
#include "vision/flow/flow.h"

namespace faba {

/// Flow between two consecutive frames.
struct FlowPair {
  std::uint64_t frame = 0;  ///< index of the first one
  double t0_s = 0, t1_s = 0;
  Flow flow;  ///< px of the video per pair, on the pixel grid of the source
  /// The second frame, grey levels 0 to 255, same size; none when read from a file of flows.
  std::shared_ptr<const GrayF> image;
};

/// Options for the computation of flows from frames.
struct FlowSourceOptions {
  FlowRegistry::PartType method;  ///< flow part; ignored for files of flows
  int shrink = 0;                 ///< side of the blocks over which frames are averaged, px; 0: see kLongSide
  double t0_s = 0;                ///< start time
  std::optional<double> t1_s = {};  ///< end time
  std::uint64_t samples = 0;        ///< > 0: only about this number of pairs, spread over the interval
  double fps = 0;                   ///< > 0: overrides the frame rate of the video
  std::string options_text = {};    ///< options given by the user, "--pyramid, --shrink", for a note
  bool frames = false;              ///< frames are needed with the flows: the video of a run is used
  unsigned threads = 0;             ///< 0: all; each computes the flow of another pair
  FrameInspector inspect = {};      ///< may be empty; not called for files of flows
  /// A reading of samples keeps its flows here, a complete reading takes them from here. May be empty.
  std::shared_ptr<KeptFlows> kept = {};
};

/// The flows of a video, a run directory or a file of flows in sequence; memory does not depend on their
/// number. Of a run the recorded flows are used, or else its video.
class FlowSource {
 public:
  /// By default larger frames are shrunk until their longer side is at most this, px.
  static constexpr int kLongSide = 1024;

  /// Throws Error(input) when `path` cannot be read, is empty, or contains no frames where these are needed;
  /// Error(usage) when `shrink` is too large for the frames.
  FlowSource(const std::filesystem::path& path, const FlowSourceOptions& options);
  ~FlowSource();

  /// The next pair; false at the end. A truncated file ends with its last readable frame: see notes(). Throws
  /// Error(input) at the end of a video with one frame only, and of an interval without a pair.
  bool next(FlowPair& pair);

  int width() const;   ///< of the flows, px
  int height() const;  ///< of the flows, px
  /// Scale of the frames: px of the video per px of the flows; 1 for files of flows.
  int shrink() const;
  double fps() const;  ///< stated in the file; 0: unknown
  /// Only pairs whose index is a multiple of this are computed.
  std::uint64_t every() const;
  /// Pairs of the interval from t0_s to t1_s as stated in the file, for progress; 0: unknown.
  std::uint64_t pairs() const;
  const VideoScale& scale() const;
  /// The flow method and its parameters, as JSON.
  const std::string& method() const;
  /// Notes for the user on the pairs that were taken: damage, shrinking, grey scaling, missing frame rate.
  std::vector<std::string> notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
