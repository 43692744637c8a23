#include "control/centroid.h"
#include "control/controller.h"

namespace faba {
namespace {

/// The thesis's estimate: arithmetic mean of all cells, including those outside the view (theory A10).
/// Available in simulations only; on a real setup it equals `visible`.
class EstimatorMean final : public Estimator {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::needs_positions};
  static Schema<Params> schema() {
    return Schema<Params>("mean", "Mean of all cells, in view or not, as in the thesis")
        .validity("A camera cannot detect cells outside its view; use `visible` for a realistic estimate.");
  }
  EstimatorMean(const Params&, const ControlContext&) {}
  Estimate update(const Observation& o, const Command&) override { return centroid_.update(o, false); }
  void archive(Archive& a) override { a& centroid_; }

 private:
  Centroid centroid_;
};

}  // namespace

void add_mean(EstimatorRegistry& r) { r.add<EstimatorMean>(); }

}  // namespace faba
