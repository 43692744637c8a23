#include <algorithm>

#include "control/centroid.h"
#include "control/controller.h"
#include "control/foreground_params.h"
#include "vision/image/image.h"

namespace faba {
namespace {

/// The swarm from the camera frame without detection of single cells (vision/foreground/foreground.h):
/// centroid and covariance of the foreground signal. `groups` has one group; its share is the present signal
/// over the largest so far, the visible fraction of the swarm.
class EstimatorImage final : public Estimator {
 public:
  using Params = ForegroundParams;
  static constexpr std::array kTraits = {Trait::needs_pictures};
  static Schema<Params> schema() {
    return foreground_schema("image", "Centroid, dispersion and visible fraction from the camera frame")
        .validity(
            "It needs camera.sensor = \"frames\". Overlapping cells are undercounted; the cell count has an "
            "error of about 30 %. Dirt of the size of a cell counts as a cell until it is absorbed.");
  }
  EstimatorImage(const Params& p, const ControlContext& c) : frame_(c.frame), foreground_(p.options()) {}

  Estimate update(const Observation& o, const Command&) override {
    const Gray8& picture = camera_picture(o, frame_);
    foreground_.take(picture, has_frame_ ? o.t - t_ : 0);
    const SwarmMoments m = foreground_.moments();
    Estimate e;
    e.t = o.t;
    e.centroid = at_;
    e.visible = m.cells;
    if (m.signal > 0) {
      const double area = frame_.m_per_px * frame_.m_per_px;
      e.centroid = frame_.world_from_image(m.centroid_image);
      e.cov = {area * m.cov_px2.xx, -area * m.cov_px2.xy, area * m.cov_px2.yy};
      e.centroid_cov = sample_cov(e.cov, m.cells);
      if (has_centroid_ && o.t > centroid_t_) e.velocity = (1 / (o.t - centroid_t_)) * (e.centroid - at_);
      at_ = e.centroid;
      centroid_t_ = o.t;
      has_centroid_ = true;
      largest_signal_ = std::max(largest_signal_, m.signal);
      e.groups.push_back({e.centroid, m.signal / largest_signal_, e.cov});
    }
    t_ = o.t;
    has_frame_ = true;
    return e;
  }
  void archive(Archive& a) override {
    a& foreground_& at_& t_& centroid_t_& largest_signal_& has_frame_& has_centroid_;
  }

 private:
  Frame frame_;
  Foreground foreground_;
  Vec2 at_;  ///< last centroid, m, world
  double t_ = 0, centroid_t_ = 0, largest_signal_ = 0;
  bool has_frame_ = false, has_centroid_ = false;
};

}  // namespace

void add_image(EstimatorRegistry& r) { r.add<EstimatorImage>(); }

}  // namespace faba
