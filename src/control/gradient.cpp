#include "control/trap.h"

namespace faba {
namespace {

/// Open loop: a zero of the field is put at the setpoint, and the swarm gathers there by itself (theory C6).
/// Fails with two coils, whose zero is a saddle, and by B_E / g where the Earth's field is not allowed for.
class Gradient final : public Controller {
 public:
  struct Params {
    Trap::Params trap;
  };
  static constexpr std::array kTraits = {Trait::feedback, Trait::seeks_null};
  static Schema<Params> schema() {
    return Schema<Params>("gradient",
                          "Open loop: a zero of the field at the setpoint gathers the swarm there")
        .include(&Params::trap, Trap::Params::schema())
        .validity(
            "Two coils make a saddle, which drives cells away along one direction. Cells are drawn "
            "to the zero from this side of the next zeros, some millimetres away, and driven off from "
            "beyond, also "
            "when the setpoint is that far; near it the cloud is as wide as sqrt(v f_r / (m g)).");
  }
  Gradient(const Params& p, const ControlContext& c) : trap_(p.trap, c) {}
  Command update(const Estimate&, const Target& target, double) override { return trap_.at(target.position); }
  void archive(Archive& a) override { trap_.archive(a); }

 private:
  Trap trap_;
};

}  // namespace

void add_gradient(ControllerRegistry& r) { r.add<Gradient>(); }

}  // namespace faba
