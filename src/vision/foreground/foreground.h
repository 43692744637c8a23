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
  Polarity polarity = Polarity::automatic;  ///< automatic: told by the first picture; not both
  double threshold_sd = 5;  ///< of the smoothed noise, from which on a place counts as covered by cells
  double absorb_s = 150;    ///< time in which what stands still becomes background, s
  bool learn = true;        ///< false: the background is found in each picture anew
};

/// What a picture shows of a swarm. Image frame, px, y down.
struct SwarmMoments {
  double signal = 0;  ///< integrated difference from the background, grey px^2; 0: no swarm is seen
  Vec2 centroid_image;
  Mat2 cov_px2;      ///< of the cells' positions: the width of a cell is taken off; x right, y down
  double cells = 0;  ///< estimate of their number, from the signal and that of patches of one or two
};

/// Where a swarm is in a picture, without finding its cells one by one: the difference from a background,
/// counted only where cells are. Differences are summed with their sign, so that noise cancels, over the
/// places whose smoothed difference is above a threshold and their surroundings, so that uneven light far
/// from cells does not count. Where cells are dark it is the logarithm of light over background that is
/// summed, in grey of the mean background: light lost to one cell is lost to the next, and a cell takes the
/// same share of it everywhere. A connected patch of a few cells is counted as a whole number of them,
/// whatever its noise and however faint they are; of more its signal counts.
///
/// The background of the first picture is the picture itself, with what is small in every direction filled in
/// (line_closing): lines, as the edge of a drop, are background. It then follows the picture within 2 s where
/// no cells are, at once where the picture shows that the background is lighter (for dark cells) than
/// believed, and where cells are by a share dt / absorb_s only: a swarm that stands still loses 6 % of its
/// signal in ten seconds. What was filled in is a guess: a place of it where nothing moves for a second after
/// something has, or for ten if nothing ever has, has no cells. A change of brightness by a common factor is
/// taken off.
///
/// Only additions, multiplications and square roots in a fixed order: same bits on every machine.
class Foreground {
 public:
  explicit Foreground(ForegroundOptions options = {});

  /// From now on this is the background, as a whole video shows it, and nothing is learnt from pictures.
  void know(const Background& background);

  /// Looks at the picture that was taken `dt_s` after the one before (any value for the first). When the size
  /// changes it begins anew.
  void take(const Gray8& picture, double dt_s);
  /// The same for a picture of other than 8 bits, brought to greys of 0 to 255, with noise of `noise` grey.
  void take(const GrayF& picture, double noise, double dt_s);

  /// What the last picture shows.
  SwarmMoments moments() const;
  /// Difference from the background of each pixel, with its sign (positive where cells are), 0 where none
  /// are.
  const GrayF& weights() const { return weights_; }
  /// The stretches of rows that cells cover, and the patch that each is of, in the last picture.
  const std::vector<PatchRun>& runs() const { return runs_; }
  /// Of each pixel whether cells are there: not 0.
  const std::vector<std::uint8_t>& covered() const { return covered_; }
  void archive(Archive& a);

 private:
  void begin(const GrayF& picture, double noise);
  bool proves_background(std::size_t i, float least_change, float dt_s);
  void look(double noise, double dt_s);
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
  double sd_px_ = 1, sign_ = 0;  ///< of a cell; -1 dark, +1 bright, 0 not yet known
  double cell_signal_ = 0;       ///< grey px^2
  double cell_guess_ = 0;        ///< from the last picture alone
  double noisiest_ = 0;          ///< of the pictures lately, grey
  double own_noise_ = 0;         ///< variance of the background over that of the picture's noise
  std::uint64_t frames_ = 0;     ///< that the background rests on
  bool known_ = false;           ///< the background is given
  GrayF background_, weights_, smooth_, picture_, scratch_;
  std::vector<std::uint8_t> covered_, work_;
  std::vector<PatchRun> runs_;  ///< of the last picture
  /// Of the pixels that were covered in the first picture, whose background is a guess: whether they have
  /// changed since, the smoothed difference that they had when they last did, and for how long they have been
  /// still, s.
  enum Guess : std::uint8_t { seen, guessed, changed };
  std::vector<std::uint8_t> guess_;
  std::vector<float> still_grey_, still_s_;
};

/// Standard deviation of a picture's noise, grey, from the differences of neighbours in a row; at least 0.3.
double picture_noise(const Gray8& picture);

}  // namespace faba
