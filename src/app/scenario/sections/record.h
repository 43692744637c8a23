#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "core/schema.h"

namespace faba {

/// Frames `first` to `end` - 1 of a run.
struct FrameRange {
  std::uint64_t first = 0, end = std::numeric_limits<std::uint64_t>::max();
};

/// The table [record]: files that a run records.
struct Record {
  bool tracks = true;
  int tracks_every = 1;
  double resolution_px = 0;
  bool compress = true;
  bool video = true;
  int video_every = 1;
  bool lossless = false;
  bool as_seen = false;
  bool flow = false;
  double checkpoint = 10;
  double from = 0;           ///< s, simulated time
  std::optional<double> to;  ///< s; empty: the end of the run
  static Schema<Record> schema();
};

}  // namespace faba
