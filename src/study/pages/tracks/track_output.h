#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "vision/cells/tracker.h"

namespace faba {

/// A table of tracks being written under a temporary name, which is gone unless complete() is called.
/// CSV: `track,frame,t_s,x_px,y_px,mass,snr`. HDF5: a table of each of these names, and attributes
/// `format` = "faba tracked 1", `um_per_px` (when known), `width_px`, `height_px`. Rows of one piece of a
/// track stand together.
class TrackOutput {
 public:
  virtual ~TrackOutput() = default;
  virtual void write(const Track& track) = 0;
  virtual void complete() = 0;
};

/// What is said of the video in the head of an HDF5 file. um_per_px 0: not known.
struct TrackedVideo {
  int width = 0, height = 0;
  double um_per_px = 0;
};

/// By the ending of `path`: .csv or .h5. Throws Error(Errc::usage) for another one, Error(Errc::internal)
/// when it cannot be written.
std::unique_ptr<TrackOutput> track_output(const std::filesystem::path& path, const TrackedVideo& video);

}  // namespace faba
