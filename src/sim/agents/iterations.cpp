#include "sim/agents/iterations.h"

#include <fmt/format.h>

#include <cmath>

#include "core/vectorised.h"

namespace faba {
namespace {

FABA_VECTORISED void advance(const float* x, const float* __restrict v, float* to, std::size_t n,
                             float metres) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) to[i] = x[i] + metres * v[i];
}

}  // namespace

Iterations::Iterations(const ModelContext& c, int hold) : hold_(std::uint64_t(hold)) {
  const double ratio = c.scale.iteration / c.step, steps = std::floor(ratio + 0.5);
  if (steps < 1 || std::fabs(ratio - steps) > 1e-6)
    throw Error(Errc::usage, "scale.iteration",
                fmt::format("{:.4g} s is not an integer multiple of the time step {:.4g} s; change "
                            "scale.iteration, simulation.step or camera.rate",
                            c.scale.iteration, c.step));
  steps_ = std::uint64_t(steps);
}

void Iterations::move(State& s, const StepContext& c, float m_per_px) const {
  const float metres = moves(s.step) ? m_per_px : 0.0f;
  const std::size_t n = c.end - c.begin;
  auto& a = s.agents;
  advance(&a["x"][c.begin], &a["vx"][c.begin], &c.to_x[c.begin], n, metres);
  advance(&a["y"][c.begin], &a["vy"][c.begin], &c.to_y[c.begin], n, metres);
}

std::vector<ColumnSpec> Iterations::columns() {
  return {{"vx", "px/iteration", "held velocity to the right"},
          {"vy", "px/iteration", "held velocity upwards"}};
}

}  // namespace faba
