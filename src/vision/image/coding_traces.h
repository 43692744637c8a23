#pragma once
#include <vector>

#include "core/threads/parallel.h"
#include "vision/image/compact_image.h"
#include "vision/image/image.h"

namespace faba {

/// Traces of lossy coding in the changes of a video. Codecs such as H.264, HEVC, VP9 and MPEG-4 quantise the
/// changes of a picture in blocks whose sides are multiples of 8 px (or 4 px): a change has steps between
/// blocks, and blocks without a large change are copied, so they have no noise. The noise of a camera has no
/// such grid.
struct CodingTraces {
  double block_steps = 0;   ///< mean absolute step across the edges of the grid over that elsewhere, minus 1
  double significance = 0;  ///< of block_steps, in its standard errors
  double unchanged = 0;     ///< fraction of the blocks of 8 px that are equal in two frames

  /// Whether the video was coded. Without coding, the largest of the 16 phases is above 5 standard errors in
  /// about one of 10^4 videos (t distribution, 40 periods); smaller steps than 0.02 are assumed to have no
  /// influence on the noise.
  bool coded() const { return significance >= 5 && block_steps >= 0.02; }
};

/// The traces in the differences of successive `frames` of equal size, at most the first 12 pairs. Frames
/// that were averaged over blocks or resized have no grid. Zero for frames smaller than 64 px. The result
/// does not depend on the number of threads.
CodingTraces coding_traces(const std::vector<CompactImage>& frames, Pool& pool);

/// Noise of a filtered `response` in the blocks in which `difference`, that of a frame from the background,
/// is not zero: its 80 % quantile as that of a normal distribution (the errors of coding have a wide
/// distribution, and less than a fifth of these blocks is covered by objects). 0 if there are none.
float coded_noise(const GrayF& difference, const GrayF& response);

}  // namespace faba
