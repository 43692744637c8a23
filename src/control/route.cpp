#include "control/controller.h"

namespace faba {
namespace {

/// A sequence of setpoints (theory A10). It advances when the swarm has been within `tolerance_px` for
/// `hold_frames` consecutive frames, or after `timeout`. The last setpoint is held.
class ReferenceRoute final : public Reference {
 public:
  struct Params {
    std::vector<Vec2> setpoints_px;
    double tolerance_px = 10;
    int hold_frames = 15;
    std::optional<double> timeout;
  };
  static Schema<Params> schema();
  ReferenceRoute(const Params& p, const ControlContext& c);
  Target update(const Estimate& e) override;
  std::vector<Vec2> setpoints() const override { return points_; }
  std::optional<double> tolerance_px() const override { return p_.tolerance_px; }
  void archive(Archive& a) override { a& index_& inside_& since_& started_& finished_; }

 private:
  Params p_;
  std::vector<Vec2> points_;
  double tolerance_;  ///< m
  std::uint64_t index_ = 0;
  int inside_ = 0;
  double since_ = 0;  ///< start time of the present setpoint, s
  bool started_ = false, finished_ = false;
};

Schema<ReferenceRoute::Params> ReferenceRoute::schema() {
  return Schema<Params>("route", "A sequence of setpoints")
      .add("setpoints_px", &Params::setpoints_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Setpoints in image coordinates, y down: [[100, 120], [300, 200]]"})
      .add("tolerance_px", &Params::tolerance_px,
           {.unit = "px",
            .min = 0,
            .max = 1e4,
            .doc = "Distance within which a setpoint counts as reached",
            .source = "assumed (A10)"})
      .add("hold_frames", &Params::hold_frames,
           {.min = 1,
            .max = 1e6,
            .doc = "Consecutive frames within the tolerance before the next setpoint",
            .source = "assumed (A10)"})
      .add("timeout", &Params::timeout,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc =
                "Time after which the next setpoint is used even if this one is not reached; no timeout when "
                "absent"})
      .check([](const Params& p) -> std::string {
        return p.setpoints_px.empty()
                   ? "setpoints_px is empty; specify at least one setpoint, such as [[100, 120]]"
                   : "";
      });
}

ReferenceRoute::ReferenceRoute(const Params& p, const ControlContext& c)
    : p_(p), tolerance_(p.tolerance_px * c.scale.m_per_px) {
  for (const Vec2 s : p.setpoints_px) points_.push_back(c.frame.world_from_image(s));
}

Target ReferenceRoute::update(const Estimate& e) {
  const bool first = !started_;
  if (first) {
    started_ = true;
    since_ = e.t;
  }
  const bool near = e.visible > 0 && norm(e.centroid - points_[index_]) < tolerance_;
  inside_ = near ? inside_ + 1 : 0;
  const bool timed_out = p_.timeout && e.t - since_ >= *p_.timeout;
  // The first frame has the first setpoint in any case: a recording contains all setpoints of the route.
  if (!first && (inside_ >= p_.hold_frames || timed_out)) {
    if (index_ + 1 < points_.size()) {
      ++index_;
      inside_ = 0;
      since_ = e.t;
    } else {
      finished_ = true;
    }
  }
  return {points_[index_], std::size_t(index_), finished_};
}

}  // namespace

void add_route(ReferenceRegistry& r) { r.add<ReferenceRoute>(); }

}  // namespace faba
