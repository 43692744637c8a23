#include "control/controller.h"

namespace faba {
namespace {

/// One constant setpoint.
class ReferenceHold final : public Reference {
 public:
  struct Params {
    std::optional<Vec2> setpoint_px;
  };
  static Schema<Params> schema();
  ReferenceHold(const Params& p, const ControlContext& c)
      : at_(p.setpoint_px ? c.frame.world_from_image(*p.setpoint_px) : Vec2{}) {}
  Target update(const Estimate&) override { return {at_, 0, false}; }
  std::vector<Vec2> setpoints() const override { return {at_}; }

 private:
  Vec2 at_;
};

Schema<ReferenceHold::Params> ReferenceHold::schema() {
  return Schema<Params>("hold", "One constant setpoint")
      .add("setpoint_px", &Params::setpoint_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Setpoint in image coordinates, y down; default: the centre of the arena"});
}

}  // namespace

void add_hold(ReferenceRegistry& r) { r.add<ReferenceHold>(); }

}  // namespace faba
