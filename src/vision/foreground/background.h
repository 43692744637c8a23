#pragma once
#include <cstdint>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// How what is looked for differs from the background.
enum class Polarity {
  automatic,  ///< told from the skewness of the differences
  dark,       ///< darker than the background, as unstained cells in focus in bright field
  bright,     ///< brighter, as in dark field and fluorescence
  both        ///< either
};

/// What a video shows where nothing is.
struct Background {
  GrayF level;     ///< grey, in the video's own scale
  GrayF noise_sd;  ///< temporal standard deviation of each pixel, grey; > 0
  int frames = 0;  ///< that it rests on
};

/// The background of a video from frames spread over it, handed in one by one in the order of the video; how
/// many there will be need not be known. Keeps at most `most_frames` of them, and fewer when they would not
/// fit into `most_bytes`, by dropping every second one when full: memory does not grow with the length.
class BackgroundSampler {
 public:
  explicit BackgroundSampler(int most_frames = 50, std::size_t most_bytes = 256u << 20);

  /// Looks at the next frame. All must have the size of the first, else Error(Errc::internal).
  void take(const GrayF& frame);
  /// Frames kept so far.
  const std::vector<GrayF>& kept() const { return kept_; }

  /// Per pixel the median over the kept frames, and 1.4826 times the median absolute deviation from it as
  /// noise, smoothed over 9 px since the scatter of the estimate itself is large (12 % for 50 frames); at
  /// least a quarter of a grey step. A pixel that is covered in more than half of the frames is taken for
  /// background as it is then: things that never move vanish. An empty Background when no frame was taken.
  Background background() const;

 private:
  int most_frames_;
  std::size_t most_bytes_;
  std::uint64_t seen_ = 0, stride_ = 1;
  std::vector<GrayF> kept_;
};

/// Background of a single frame: the frame smoothed by a Gaussian of `sd_px`, which should be several times
/// the size of what is looked for and smaller than what the light varies over. Noise: one value for all
/// pixels, from the differences of neighbours in a row without the largest, which smooth structure hardly
/// changes.
Background spatial_background(const GrayF& frame, double sd_px);

/// Dark or bright, by the sign of the third moment of the differences from their median, those beyond 3
/// robust standard deviations only: the noise itself has no say. Dark when there is no such difference.
Polarity polarity_of(const std::vector<float>& differences);

}  // namespace faba
