#pragma once
#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/vec.h"
#include "vision/foreground/background.h"
#include "vision/foreground/kernels/foreground_pixels.h"
#include "vision/image/image.h"
#include "vision/image/patches.h"

namespace faba {

/// Parameters of Foreground.
struct ForegroundOptions {
  double cell_px = 3;  ///< full width at half maximum of a cell in the picture, px, 1 to 20
  Polarity polarity = Polarity::automatic;  ///< automatic: from the first picture; `both` is not permitted
  double threshold_sd = 5;                  ///< foreground threshold, in sd of the smoothed noise
  double absorb_s = 150;  ///< time constant with which immobile objects become background, s
  bool learn = true;      ///< false: the background is estimated from each picture separately
};

/// Moments of a swarm in a picture. Image frame, px, y down.
struct SwarmMoments {
  double signal = 0;  ///< integrated difference from the background, grey px^2; 0: no swarm detected
  Vec2 centroid_image;
  Mat2 cov_px2;      ///< covariance of the cell positions, corrected for the width of a cell; x right, y down
  double cells = 0;  ///< estimated number of cells, from the total signal and the signal of one cell
};

/// Position and extent of a swarm in a picture without detection of single cells, by background subtraction
/// in a foreground mask. The foreground mask contains the pixels whose smoothed difference exceeds a
/// threshold, dilated. The differences inside the mask are summed with their sign, so that noise cancels;
/// uneven light outside the mask has no influence. For dark cells the logarithm of the ratio of light to
/// background is summed (in grey of the mean background): cells absorb the same fraction of the light
/// everywhere, and the absorption of overlapping cells adds up. The signal of a connected component of a few
/// cells is rounded to an integer number of cells, which removes the influence of noise and contrast; larger
/// components contribute their signal.
///
/// Background model: the first one is the first picture with small objects filled by line_closing; long lines
/// such as the edge of a drop remain background. Without cells the model follows the picture with a time
/// constant of 2 s; where the background is lighter (for dark cells) than the model, it is corrected at once;
/// under cells it follows with the fraction dt / absorb_s only: an immobile swarm loses 6 % of its signal in
/// ten seconds. Filled pixels are a guess: such a pixel is assumed to be background when it is constant for
/// one second after a change, or for ten seconds without any change. Common changes of brightness are
/// corrected.
///
/// Uses only additions, multiplications and square roots in a fixed order: bit-identical on every machine.
class Foreground {
 public:
  /// Throws Error(internal) for the polarity `both`.
  explicit Foreground(ForegroundOptions options = {});

  /// Sets a given background, for example of a complete video, and disables the background update.
  void set_background(const Background& background);

  /// Processes a picture taken `dt_s` after the previous one (any value for the first). A change of size
  /// resets the model.
  void take(const Gray8& picture, double dt_s);
  /// As above for other bit depths: grey values scaled to 0..255, noise sd `noise` in grey.
  void take(const GrayF& picture, double noise, double dt_s);

  /// Moments of the last picture.
  SwarmMoments moments() const;
  /// Difference from the background of each pixel, positive for cells; 0 outside the foreground mask.
  const GrayF& weights() const { return weights_; }
  /// Runs of the foreground mask of the last picture with the number of their connected component.
  const std::vector<ComponentRun>& runs() const { return runs_; }
  /// Foreground mask: non-zero where cells are.
  const std::vector<std::uint8_t>& covered() const { return covered_; }
  void archive(Archive& a);

 private:
  void begin(const GrayF& picture, double noise);
  bool proves_background(std::size_t i, float least_change, float dt_s);
  void process(double noise, double dt_s);
  void find_covered(float gain, double noise);
  float middle_brightness() const;
  void take_logarithms(const LightLoss& loss, int first, int end);
  struct Learning {
    Following follow;
    float least_change, dt_s;
  };
  Learning learn_at(double gain, double dt_s, double noise);
  void learn(const Learning& l, int first, int end);
  double guess_cell_signal() const;
  double noise_below_background() const;
  double signal_of_one(std::vector<double> patches) const;
  void count_cells();
  double smoothing_gain() const;

  ForegroundOptions options_;
  double sd_px_ = 1, sign_ = 0;    ///< sd of a cell; -1 dark, +1 bright, 0 unknown
  double cell_signal_ = 0;         ///< signal of one cell, grey px^2
  double cell_guess_ = 0;          ///< estimate from the last picture, grey px^2
  double recent_noise_ = 0;        ///< decaying maximum of the picture noise, grey
  double background_noise_ = 0;    ///< noise variance of the background relative to that of a picture
  std::uint64_t frames_ = 0;       ///< number of frames in the background
  bool background_given_ = false;  ///< the background was set by set_background()
  GrayF background_, weights_, smooth_, picture_, scratch_;
  std::vector<std::uint8_t> covered_, work_;
  std::vector<ComponentRun> runs_;  ///< runs of the last picture
  /// State of the pixels that were covered in the first picture, whose background is a guess: whether they
  /// have changed, their smoothed difference at the last change, and the time since then, s.
  enum Guess : std::uint8_t { observed, guessed, changed };
  std::vector<std::uint8_t> guess_;
  std::vector<float> still_grey_, still_s_;
};

/// Standard deviation of the noise of a picture, grey, from the differences of horizontal neighbours; at
/// least 0.3.
double picture_noise(const Gray8& picture);

}  // namespace faba
