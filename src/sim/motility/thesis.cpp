#include <algorithm>
#include <cmath>

#include "core/draw_blocks.h"
#include "sim/motility.h"
#include "sim/motility/oxygen.h"

namespace faba {
namespace {

/// Loss of motility in air (theory A16, B5). With t the time in air, exposure before the run included:
///   speed(t) = speed(0) / (1 + slowdown t);
/// a cell's dose grows as dX/dt = max(c - tolerated, 0), c the local oxygen as a fraction of saturation
/// (diffusion from the drop's edge; 1 in a box), and a cell whose dose exceeds its own lognormal tolerance no
/// longer feels the field. The dose before the run is that of the place where the cell starts. Known to fail:
/// the cells' own oxygen uptake and evaporation are neglected.
class MotilityThesis final : public Motility {
 public:
  struct Params {
    double slowdown = 0.00524;
    double tolerance = 430;
    double tolerance_sigma = 0.2;
    double oxygen_diffusivity = 2e-9;
    double tolerated = 0;
  };
  static Schema<Params> schema();
  MotilityThesis(const Params& p, const MotilityContext& c);
  std::vector<ColumnSpec> columns() const override;
  void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const override;
  double vigour(double t) const override { return 1 / (1 + p_.slowdown * (exposure_ + t)); }
  void step(State& s, const StepContext& c) const override;

 private:
  Params p_;
  double exposure_;
  std::optional<OxygenProfile> oxygen_;  ///< absent in a box
  double radius_ = 0;                    ///< m
};

Schema<MotilityThesis::Params> MotilityThesis::schema() {
  return Schema<Params>("thesis",
                        "Cells slow down in air and stop responding, those near the drop's edge first")
      .add("slowdown", &Params::slowdown,
           {.unit = "1/s",
            .min = 0,
            .max = 1,
            .doc = "Speed falls as 1 / (1 + slowdown t) with the time t in air",
            .source = "eq. 4.1 of the thesis read as a travel time (A16)"})
      .add(
          "tolerance", &Params::tolerance,
          {.unit = "s",
           .min = 1,
           .max = 1e6,
           .doc = "Median dose, in seconds of saturated oxygen, that silences a cell",
           .source =
               "assumed: with the spread below 1 % respond at 660 s, as next to none did after 700 s in air"})
      .add("tolerance_sigma", &Params::tolerance_sigma,
           {.min = 0,
            .max = 3,
            .doc = "Standard deviation of the logarithm of the tolerance",
            .source = "assumed"})
      .add("oxygen_diffusivity", &Params::oxygen_diffusivity,
           {.unit = "m^2/s",
            .min = 1e-12,
            .max = 1e-6,
            .doc = "Diffusion constant of oxygen in the drop",
            .source = "Han & Bartels 1996 at 25 C (B5)"})
      .add("tolerated", &Params::tolerated,
           {.min = 0,
            .max = 1,
            .doc = "Oxygen, as a fraction of saturation, that does no harm",
            .source = "assumed 0"})
      .validity(
          "Fitted to one thesis; the cells' own uptake of oxygen, which protects dense drops, is neglected.");
}

MotilityThesis::MotilityThesis(const Params& p, const MotilityContext& c) : p_(p), exposure_(c.exposure) {
  const Frame f = c.arena->frame();
  radius_ = c.arena->outline().radius_px * f.m_per_px;
  if (radius_ > 0) oxygen_.emplace(radius_, p.oxygen_diffusivity);
}

std::vector<ColumnSpec> MotilityThesis::columns() const {
  return {{"dose", "s", "harm done by oxygen, in seconds at saturation"},
          {"tolerance", "s", "dose at which the cell stops responding"}};
}

void MotilityThesis::start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const {
  auto& a = s.agents;
  auto dose = a["dose"], tolerance = a["tolerance"], response = a["response"];
  const auto x = a["x"], y = a["y"];
  for (std::size_t i = begin; i < end; ++i) {
    const double r = norm(Vec2{double(x[i]), double(y[i])});
    // Below the tolerated level nothing happens; the series has no closed form for that, so its end value
    // stands in.
    const double before = oxygen_ ? oxygen_->dose(r, exposure_) : exposure_;
    dose[i] = float(before * (1 - p_.tolerated));
    const auto w = draw(seed, kToleranceDraws, std::uint32_t(i), 0);
    tolerance[i] = float(p_.tolerance * portable::exp(p_.tolerance_sigma * double(normals(w[0], w[1])[0])));
    if (dose[i] > tolerance[i]) response[i] = 0;
  }
}

void MotilityThesis::step(State& s, const StepContext& c) const {
  auto& a = s.agents;
  auto dose = a["dose"], response = a["response"];
  const auto tolerance = a["tolerance"], x = a["x"], y = a["y"];
  const auto dt = float(c.dt), tolerated = float(p_.tolerated);
  float nodes[OxygenProfile::kNodes];
  std::fill(std::begin(nodes), std::end(nodes), 1.0f);
  float per_node = 0;
  if (oxygen_) {
    oxygen_->profile(exposure_ + s.t, nodes);
    per_node = float((OxygenProfile::kNodes - 1) / radius_);
  }
  for (std::size_t i = c.begin; i < c.end; ++i) {
    const float at =
        std::min(std::sqrt(x[i] * x[i] + y[i] * y[i]) * per_node, float(OxygenProfile::kNodes - 1));
    const int k = std::min(int(at), OxygenProfile::kNodes - 2);
    const float oxygen = nodes[k] + (at - float(k)) * (nodes[k + 1] - nodes[k]);
    dose[i] += std::max(oxygen - tolerated, 0.0f) * dt;
    if (dose[i] > tolerance[i]) response[i] = 0;
  }
}

}  // namespace

void add_motility_thesis(MotilityRegistry& r) { r.add<MotilityThesis>(); }

}  // namespace faba
