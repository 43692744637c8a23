#include "sim/start.h"

namespace faba {
namespace {

/// Uniform in the arena.
class StartUniform final : public Start {
 public:
  struct Params {};
  static Schema<Params> schema() { return {"uniform", "Uniform in the arena"}; }
  StartUniform(const Params&, const StartContext& c) : grid_(c.arena->grid()) {}
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    const auto& u = d.u;
    return Vec2{double(grid_.left) + u[0] * grid_.columns * double(grid_.cell),
                double(grid_.low) + u[1] * grid_.rows * double(grid_.cell)};
  }

 private:
  Grid grid_;
};

}  // namespace

void add_start_uniform(StartRegistry& r) { r.add<StartUniform>(); }

}  // namespace faba
