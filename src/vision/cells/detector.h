#pragma once
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/cells/spot.h"
#include "vision/foreground/background.h"
#include "vision/image/image.h"

namespace faba {

/// Smallest and largest size of spots that spot_size() estimates, and the largest that a detector accepts,
/// px.
inline constexpr double kSmallestSpot = 2, kLargestSpot = 31, kLargestDetected = 60;

/// Region of the picture that is excluded from detection.
struct DropMask {
  Vec2 centre_image;  ///< px
  double radius_px = 0;
  bool inside = true;    ///< true: spots inside the circle are detected; false: outside
  double margin_px = 0;  ///< margin at the edge that is excluded as well
};

/// Whether a position is excluded. No mask excludes nothing.
bool excludes(const std::optional<DropMask>& drop, double x_px, double y_px);

/// Parameters of Detector.
struct DetectorOptions {
  double size_px = 4;                  ///< full width at half maximum of the spots, 1 to kLargestDetected
  Polarity polarity = Polarity::dark;  ///< not automatic
  /// Expected number of false detections per frame from noise; the threshold follows from the expected number
  /// of maxima of a Gaussian random field (Adler). Noise with heavier tails gives more.
  double false_alarms = 0.1;
  double threshold_sd = 0;   ///< > 0: minimum signal-to-noise ratio, overrides false_alarms
  double separation_px = 0;  ///< minimum distance of two maxima; 0: half of size_px, at least 1 px
  /// The video was coded (see CodingTraces): the noise is that of the coded blocks, one value per frame.
  bool coded = false;
  std::optional<DropMask> drop;
};

/// Spot detection with sub-pixel positions, for spots of similar size.
///
/// The difference from the background is filtered by a band pass matched to the spot size (difference of
/// Gaussians with sd s and 2.5 s, where s is the sd of the spot). The noise is the robust spread of the
/// result times the relative noise of the background. Local maxima above a threshold are candidates. The
/// position of each candidate is the centre of a Gaussian window of the spot size that is moved to the
/// centroid under the window until it converges; for a Gaussian spot this reaches the Cramer-Rao bound. The
/// light of neighbouring spots is subtracted, in two passes. The reported standard error is that bound,
/// sqrt(2 / pi) noise / amplitude. Spots closer to the border than half their size are excluded, because
/// their position would be biased.
class Detector {
 public:
  /// Throws Error(Errc::internal) for options out of range.
  Detector(Background background, DetectorOptions options);

  /// Spots of one frame, which has the size of the background, sorted from top to bottom.
  std::vector<Spot> find(const GrayF& frame) const;
  /// Minimum signal-to-noise ratio of a spot.
  double threshold_sd() const { return threshold_; }
  const DetectorOptions& options() const { return options_; }

 private:
  double relative_noise(int col, int row) const;

  Background background_;
  GrayF relative_noise_;  ///< over the typical one; empty if it is the same everywhere
  DetectorOptions options_;
  double sd_px_ = 1, threshold_ = 5, noise_gain_ = 1;
};

/// Signal-to-noise threshold at which noise gives `false_alarms` maxima in a picture of `pixels` pixels after
/// the band pass for spots of `size_px`.
double detection_threshold(double size_px, double pixels, double false_alarms);

/// Two sizes that are both frequent in a frame: the estimate is ambiguous.
struct TwoSizes {
  double smaller_px = 0, larger_px = 0;
  bool most_have_other = false;  ///< the most frequent size is not the estimate
};

/// Size of the spots of a frame.
struct SpotSize {
  double px = 0;  ///< full width at half maximum; 0: no spots
  std::optional<TwoSizes> two;
};

/// Estimates the size of spots: the one of 2, 2.4, 2.9 ... 30.8 px whose matched filter has the largest
/// signal-to-noise ratio (relative to white noise) at the strongest maxima. 0 when no maximum is significant
/// at any size.
SpotSize spot_size(const GrayF& frame, const Background& background, Polarity polarity, Pool& pool);

}  // namespace faba
