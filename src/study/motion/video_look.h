#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/quality/quality.h"
#include "vision/image/image.h"

namespace faba {

/// Change of the brightness from frame to frame.
class LightChange {
 public:
  /// Frames in sequence; none, as of flows from a file, and those smaller than 3 x 3 px are ignored.
  void add(std::shared_ptr<const GrayF> frame);
  /// Displacement, px, that the mean change of the brightness imitates at the mean gradient; 0 without
  /// frames.
  double imitated_px() const;

 private:
  std::shared_ptr<const GrayF> before_;
  double imitated_px_ = 0;  ///< sum over pairs
  int pairs_ = 0;
};

/// Properties of the frames of a video on which the optical flow of equal motion depends.
class VideoLook {
 public:
  /// Frames in sequence; none, as of flows from a file, and those smaller than 3 x 3 px are ignored.
  void add(std::shared_ptr<const GrayF> frame);

  bool empty() const { return pairs_ == 0; }
  /// Standard deviation of the noise, grey levels.
  double noise() const;
  /// Size of what changes between frames, px: rms of the change over that of its gradient, without the noise;
  /// the standard deviation for Gaussian spots. Empty when the change is not greater than the noise.
  std::optional<double> size_px() const;
  /// As LightChange::imitated_px().
  double imitated_px() const;

 private:
  std::shared_ptr<const GrayF> before_;
  double noise_ = 0;                  ///< variances, summed over pairs
  double change_ = 0, gradient_ = 0;  ///< mean squares of the change and its gradient, summed over pairs
  double imitated_px_ = 0;
  int pairs_ = 0;
};

/// Differences of two videos that change their flows without a difference in motion. `threshold_px`: smaller
/// flows are not counted.
std::vector<Warning> look_warnings(const VideoLook& reference, const VideoLook& run, double threshold_px);

}  // namespace faba
