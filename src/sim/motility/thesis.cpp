#include <algorithm>
#include <cmath>

#include "core/random/draw_blocks.h"
#include "sim/motility.h"
#include "sim/motility/oxygen.h"

namespace faba {
namespace {

/// Loss of motility in air (theory A16, B5). With t the air exposure time, including the time before the run:
///   speed(t) = speed(0) / (1 + slowdown t);
/// the dose of a cell increases as dX/dt = max(c - tolerated, 0), c the local oxygen as a fraction of
/// saturation (diffusion from the edge of the drop; 1 in a box). A cell whose dose exceeds its lognormal
/// tolerance does not respond to the field any more. The dose before the run is that at the start position.
/// Not modelled: oxygen uptake by the cells, and evaporation.
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
  double speed_factor(double t) const override { return 1 / (1 + p_.slowdown * (exposure_ + t)); }
  void step(State& s, const StepContext& c) const override;

 private:
  Params p_;
  double exposure_;
  std::optional<OxygenProfile> oxygen_;  ///< absent in a box
  double radius_ = 0;                    ///< m
};

Schema<MotilityThesis::Params> MotilityThesis::schema() {
  return Schema<Params>("thesis",
                        "Cells slow down in air and stop responding, near the edge of the drop first")
      .add("slowdown", &Params::slowdown,
           {.unit = "1/s",
            .min = 0,
            .max = 1,
            .doc = "Speed decreases as 1 / (1 + slowdown t), t the air exposure time",
            .source = "eq. 4.1 of the thesis read as a travel time (A16)"})
      .add("tolerance", &Params::tolerance,
           {.unit = "s",
            .min = 1,
            .max = 1e6,
            .doc = "Median dose, in seconds at saturation, at which a cell stops responding",
            .source =
                "assumed: less than 1 % respond at 660 s; in the thesis, almost none after 700 s in air"})
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
            .doc = "Oxygen, as a fraction of saturation, that does not increase the dose",
            .source = "assumed 0"})
      .validity(
          "The model is fitted to one thesis. It neglects the oxygen uptake of the cells, which protects "
          "dense drops.");
}

MotilityThesis::MotilityThesis(const Params& p, const MotilityContext& c) : p_(p), exposure_(c.exposure) {
  const Frame f = c.arena->frame();
  radius_ = c.arena->outline().radius_px * f.m_per_px;
  if (radius_ > 0) oxygen_.emplace(radius_, p.oxygen_diffusivity);
}

std::vector<ColumnSpec> MotilityThesis::columns() const {
  return {{"dose", "s", "oxygen dose, in seconds at saturation"},
          {"tolerance", "s", "dose at which the cell stops responding"}};
}

void MotilityThesis::start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const {
  auto& a = s.agents;
  auto dose = a["dose"], tolerance = a["tolerance"], response = a["response"];
  const auto x = a["x"], y = a["y"];
  for (std::size_t i = begin; i < end; ++i) {
    const double r = norm(Vec2{double(x[i]), double(y[i])});
    // The dose above the tolerated level has no closed form: scaled from the total dose.
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
