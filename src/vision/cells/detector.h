#pragma once
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/cells/spot.h"
#include "vision/foreground/background.h"
#include "vision/image/image.h"

namespace faba {

/// Parts of the picture in which nothing is looked for.
struct DropMask {
  Vec2 centre_image;  ///< px
  double radius_px = 0;
  bool inside = true;    ///< whether spots lie inside the circle
  double margin_px = 0;  ///< width of the rim at the edge that is left out, too
};

/// Parameters of Detector.
struct DetectorOptions {
  double size_px = 4;                  ///< full width at half maximum of what is looked for, 1 to 60 px
  Polarity polarity = Polarity::dark;  ///< not automatic
  /// Noise alone gives this many spots per frame on average; sets the threshold by the expected number of
  /// maxima of a Gaussian random field (Adler). Real noise has longer tails and gives more.
  double false_alarms = 0.1;
  double threshold_sd = 0;   ///< > 0: least signal-to-noise itself, in place of false_alarms
  double separation_px = 0;  ///< of two maxima that both count, 0: half of size_px, at least 1 px
  std::optional<DropMask> drop;
};

/// Finds spots of about one size to a fraction of a pixel.
///
/// The difference from the background goes through a band pass matched to the size (difference of two
/// Gaussians of sd s and 2.5 s, s the sd of the spot), whose robust spread, times the background's relative
/// noise, is the noise. Local maxima above a threshold are candidates. Each one's place is then the centre of
/// a Gaussian window of the spot's own size that moves until the centre of mass under it is its own centre,
/// which for a Gaussian spot has the error of the best possible estimate, with the neighbours' share of the
/// light taken off, in two passes. The error given is that bound, sqrt(2 / pi) noise / amplitude.
/// Spots nearer to the border than half their size are left out: their centre would be biased.
class Detector {
 public:
  /// Throws Error(Errc::internal) for options out of range.
  Detector(Background background, DetectorOptions options);

  /// The spots of one frame of the background's size, from the top of the picture to its bottom.
  std::vector<Spot> find(const GrayF& frame) const;
  /// Least signal-to-noise that counts.
  double threshold_sd() const { return threshold_; }
  const DetectorOptions& options() const { return options_; }

 private:
  Background background_;
  GrayF relative_noise_;
  DetectorOptions options_;
  double sd_px_ = 1, threshold_ = 5, noise_gain_ = 1;
};

/// Least signal-to-noise with which noise alone gives `false_alarms` maxima in a picture of `pixels` pixels
/// behind the band pass for spots of `size_px`.
double detection_threshold(double size_px, double pixels, double false_alarms);

/// The size that fits a frame's spots best: of 2, 2.4, 2.9 ... 30 px the one whose matched filter would
/// stand out most from white noise at the strongest maxima. 0 when nothing stands out at any size.
double spot_size(const GrayF& frame, const Background& background, Polarity polarity);

}  // namespace faba
