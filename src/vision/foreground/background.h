#pragma once
#include <cstdint>
#include <vector>

#include "core/threads/parallel.h"
#include "vision/image/compact_image.h"
#include "vision/image/image.h"

namespace faba {

/// Contrast of the objects against the background.
enum class Polarity {
  automatic,  ///< from the skewness of the differences
  dark,       ///< darker than the background: unstained cells in focus in bright field
  bright,     ///< brighter: dark field and fluorescence
  both        ///< either
};

/// Background model of a video without its objects.
struct Background {
  GrayF level;     ///< grey, in the scale of the video
  GrayF noise_sd;  ///< temporal standard deviation of each pixel, grey; > 0
  int frames = 0;  ///< number of frames used
};

/// Background model from frames sampled over a video of unknown length, passed in order. Keeps at most
/// `most_frames` frames, and not more than need `most_bytes` as floats: when full, every second frame is
/// dropped and the stride is doubled.
class BackgroundSampler {
 public:
  explicit BackgroundSampler(int most_frames = 50, std::size_t most_bytes = 256u << 20);

  /// Whether take() may keep the next frame; otherwise skip() has the same effect without its picture.
  bool needs_next() const { return seen_ % stride_ == 0; }
  void skip() { ++seen_; }
  /// Offers the next frame. All frames must have the same size, else Error(Errc::internal).
  void take(const GrayF& frame);
  /// The final stride for a video of `frames` frames of `pixels` pixels: one of this number of frames is
  /// sampled.
  std::uint64_t stride_for(std::uint64_t frames, std::size_t pixels) const;
  /// Frames sampled so far.
  const std::vector<CompactImage>& kept() const { return kept_; }

  /// Per pixel, the median of the sampled frames; noise: 1.4826 times the median absolute deviation, smoothed
  /// over 9 px because the statistical error of the estimate is large (12 % for 50 frames), at least a
  /// quarter of a grey step. An object that covers a pixel in more than half of the frames becomes
  /// background: immobile objects are not detected. An empty Background when there are no frames.
  Background background() const;
  /// As background(), by several threads.
  Background background(Pool& pool) const;

 private:
  std::size_t most_kept(std::size_t pixels) const;

  int most_frames_;
  std::size_t most_bytes_;
  std::uint64_t seen_ = 0, stride_ = 1;
  std::vector<CompactImage> kept_;
  std::vector<CompactImage> dropped_;  ///< their memory is used for the next ones
};

/// Background of a single frame: Gaussian smoothing with `sd_px`, which should be several times the object
/// size and smaller than the scale of the illumination. Noise: one value for all pixels, from the differences
/// of horizontal neighbours without the largest ones, which is insensitive to smooth structure.
Background spatial_background(const GrayF& frame, double sd_px);

/// Dark or bright, by the sign of the third moment of the differences about their median; only values beyond
/// 3 robust standard deviations are used, so the noise has no influence. Dark when there are none.
Polarity polarity_of(const std::vector<float>& differences);

}  // namespace faba
