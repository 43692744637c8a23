#include "control/centroid.h"
#include "control/controller.h"

namespace faba {
namespace {

/// Mean of the cells in view, as measured by a camera. With none in view the last estimate is kept and
/// `visible` is 0.
class EstimatorVisible final : public Estimator {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::needs_positions};
  static Schema<Params> schema() {
    return Schema<Params>("visible", "Mean of the cells in view")
        .validity(
            "The estimate is biased towards the centre of the view when part of the swarm is outside the "
            "view.");
  }
  EstimatorVisible(const Params&, const ControlContext&) {}
  Estimate update(const Observation& o, const Command&) override { return centroid_.update(o, true); }
  void archive(Archive& a) override { a& centroid_; }

 private:
  Centroid centroid_;
};

}  // namespace

void add_visible(EstimatorRegistry& r) { r.add<EstimatorVisible>(); }

}  // namespace faba
