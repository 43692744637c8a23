#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/frame.h"
#include "core/threads/parallel.h"
#include "vision/image/circle.h"
#include "vision/image/image.h"
#include "vision/render/ground.h"
#include "vision/render/kernels/cell_splats.h"
#include "vision/render/microscope_params.h"

namespace faba {

/// Content of one camera frame.
struct Exposure {
  std::uint64_t frame = 0;  ///< frame number, below 2^32; selects the random stream of the noise
  double t = 0;             ///< s, mid-exposure; determines the lamp drift
  std::span<const CameraCell> cells;
};

/// Renders a microscope picture of cells: optics, background, drop edge, motion blur, lamp, noise and
/// quantisation (theory G). The same parameters, seed, frame and cells give the same bytes for any number of
/// threads and on every machine. Not thread-safe.
class Microscope {
 public:
  /// `edge`: the drop, image frame, px; radius 0: no drop. `frame_period`: s. `ground`: background model of
  /// the video params.background, required when that is set. Throws Error(usage) when the picture has more
  /// than 2^28 px, the exposure is longer than the frame period, or the background differs in size from the
  /// view.
  Microscope(const MicroscopeParams& params, const Frame& frame, const Circle& edge, double frame_period,
             std::uint64_t seed, const VideoBackground* ground = nullptr);

  /// Renders 8 bits: white is 255. `out` is resized.
  void render(const Exposure& e, Pool& pool, Gray8& out);
  /// Renders 16 bits: white is 65535.
  void render(const Exposure& e, Pool& pool, Image<std::uint16_t>& out);

  const GrayF& ground() const { return ground_; }          ///< background without noise, fraction of white
  double exposure_time() const { return exposure_time_; }  ///< s
  /// Standard deviation of the noise at intensity `light`, both as fractions of white, without quantisation
  /// noise.
  double noise_sd(double light) const;
  int bits() const { return params_.bits; }

 private:
  template <class T>
  void render_as(const Exposure& e, Pool& pool, Image<T>& out);

  MicroscopeParams params_;  ///< in fluorescence, as those of a bright field with the same light
  std::uint64_t seed_;
  double exposure_time_;
  double shot_ = 0, constant_ = 0;  ///< noise variance per light, and without light; fractions of white
  GrayF ground_, sum_;
  CellSplats splats_;
  std::optional<CellSplats> halos_;  ///< of phase contrast
};

}  // namespace faba
