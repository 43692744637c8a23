#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vision/flow/flow.h"

namespace faba {

/// Flow between two frames that follow each other.
struct FlowPair {
  std::uint64_t frame = 0;  ///< number of the first one
  double t0_s = 0, t1_s = 0;
  Flow flow;  ///< px of the video per pair, on a picture of the source's size
  GrayF
      image;  ///< the second frame, greys of 0 to 255, of the same size; empty when read from a file of flows
};

/// How flows are made from frames.
struct FlowSourceOptions {
  FlowRegistry::PartType method;  ///< flow part; ignored for files of flows
  int shrink = 0;                 ///< frames are averaged over squares of so many px first; 0: see kLongSide
  double t0_s = 0;                ///< from this time on
  std::optional<double> t1_s = {};  ///< up to this time
  std::uint64_t every = 1;          ///< only each pair whose number is a multiple of this
  double fps = 0;                   ///< > 0: in place of what a video states
  std::string options_text =
      {};  ///< which of these the user gave, "--pyramid, --shrink": a note when they do not apply
  bool frames = false;  ///< frames are wanted with the flows: of a run its video is taken
};

/// The flows of a video, a run directory or a file of flows, one after the other: memory does not grow with
/// their number. Of a run the flows that were recorded with it are taken, or else its video.
class FlowSource {
 public:
  /// Larger frames are shrunk, unless said otherwise, until their longer side is no longer than this, px.
  static constexpr int kLongSide = 1024;

  /// Throws Error(input) when `path` cannot be read, has fewer than two frames, or holds no frames where they
  /// are wanted; Error(usage) for a `shrink` that leaves nothing.
  FlowSource(const std::filesystem::path& path, const FlowSourceOptions& options, Pool& pool);
  ~FlowSource();

  /// The next pair; false when there is none. A file that is cut off ends where it is: see notes().
  bool next(FlowPair& pair);

  int width() const;   ///< of the flows, px
  int height() const;  ///< of the flows, px
  /// Px of the video to one of the flows; flows of a file are taken as they are.
  int shrink() const;
  double fps() const;           ///< as the file states it; 0: not stated
  std::uint64_t pairs() const;  ///< as the file states it, for progress; 0: not stated
  std::optional<double> um_per_px() const;
  /// What the flow was made with, as JSON.
  const std::string& method() const;
  /// What a reader of the result has to know: damage, shrinking, stretching. Final when next() has given
  /// false.
  std::vector<std::string> notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
