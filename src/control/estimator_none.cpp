#include <limits>

#include "control/controller.h"

namespace faba {
namespace {

/// No estimate: the centroid is NaN and no cells are visible. For field schedules, which need no estimate.
class EstimatorNone final : public Estimator {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::no_estimate};
  static Schema<Params> schema() {
    return Schema<Params>("none", "No estimate, for runs without feedback")
        .validity("The program rejects this estimator together with a feedback controller.");
  }
  EstimatorNone(const Params&, const ControlContext&) {}
  Estimate update(const Observation& o, const Command&) override {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Estimate e;
    e.t = o.t;
    e.centroid = {kNone, kNone};
    return e;
  }
};

}  // namespace

void add_estimator_none(EstimatorRegistry& r) { r.add<EstimatorNone>(); }

}  // namespace faba
