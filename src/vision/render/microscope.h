#pragma once
#include <cstdint>
#include <span>

#include "core/frame.h"
#include "core/parallel.h"
#include "vision/image/circle.h"
#include "vision/image/image.h"
#include "vision/render/ground.h"
#include "vision/render/kernels/cell_splats.h"
#include "vision/render/microscope_params.h"

namespace faba {

/// What stands before the camera during one frame.
struct Exposure {
  std::uint64_t frame = 0;  ///< number of the frame, which its noise is drawn by; below 2^32
  double t = 0;             ///< s, mid-exposure: what the lamp's drift is reckoned by
  std::span<const CameraCell> cells;
};

/// Renders cells as a camera sees them through a microscope: optics, background, drop edge, motion blur,
/// lamp, noise and quantisation (theory G). Same parameters, seed, frame and cells: same bytes, for any
/// number of threads and on every machine. Not to be shared between threads.
class Microscope {
 public:
  /// `edge`: the drop, image frame, px; radius 0 for none. `frame_period` s. `ground`: what the video
  /// params.background shows; needed when that is given. Throws Error(usage) when the picture has more than
  /// 2^28 px, the exposure is longer than a frame or the background has another size than the view.
  Microscope(const MicroscopeParams& params, const Frame& frame, const Circle& edge, double frame_period,
             std::uint64_t seed, const VideoGround* ground = nullptr);

  /// The picture, 8 bits: white is 255. `out` is resized.
  void render(const Exposure& e, Pool& pool, Gray8& out);
  /// The same in 16 bits: white is 65535.
  void render(const Exposure& e, Pool& pool, Image<std::uint16_t>& out);

  const GrayF& ground() const { return ground_; }  ///< the empty picture without noise, share of white
  double exposure_time() const { return exposure_time_; }  ///< s
  /// Sd of the noise at this light, both as shares of white, quantisation not counted.
  double noise_sd(double light) const;
  int bits() const { return params_.bits; }

 private:
  template <class T>
  void render_as(const Exposure& e, Pool& pool, Image<T>& out);

  MicroscopeParams params_;
  std::uint64_t seed_;
  double exposure_time_;
  double shot_ = 0, constant_ = 0;  ///< variance of the noise per light, and without light; shares of white
  GrayF ground_, sum_;
  CellSplats splats_;
};

}  // namespace faba
