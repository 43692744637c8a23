#include <limits>

#include "control/controller.h"

namespace faba {
namespace {

/// No setpoint: the swarm is observed, not steered; no distance to the target is reported.
class ReferenceNone final : public Reference {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::no_target};
  static Schema<Params> schema() {
    return Schema<Params>("none", "No setpoint; the default for the manual controller");
  }
  ReferenceNone(const Params&, const ControlContext&) {}
  Target update(const Estimate&) override {
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    return {{kNowhere, kNowhere}, 0, false};
  }
  std::vector<Vec2> setpoints() const override { return {}; }
};

}  // namespace

void add_none(ReferenceRegistry& r) { r.add<ReferenceNone>(); }

}  // namespace faba
