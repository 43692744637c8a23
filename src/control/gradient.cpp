#include "control/trap.h"

namespace faba {
namespace {

/// Open loop: a zero of the field is placed at the setpoint and the swarm gathers there (theory C6).
/// Fails with two coils, whose zero is a saddle. The swarm is offset by B_E / g when the Earth's field is not
/// compensated.
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
            "Two coils make a saddle, which drives cells away along one direction. Cells are trapped only "
            "within a few millimetres, up to the neighbouring zeros of the field; cells beyond them are "
            "driven away. The swarm has a width of about sqrt(v f_r / (m g)).");
  }
  Gradient(const Params& p, const ControlContext& c) : trap_(p.trap, c) {}
  Command update(const Estimate&, const Target& target, double) override { return trap_.at(target.position); }
  std::vector<Vec2> nulls(std::span<const Vec2> setpoints) const override {
    return {setpoints.begin(), setpoints.end()};
  }
  void archive(Archive& a) override { trap_.archive(a); }

 private:
  Trap trap_;
};

}  // namespace

void add_gradient(ControllerRegistry& r) { r.add<Gradient>(); }

}  // namespace faba
