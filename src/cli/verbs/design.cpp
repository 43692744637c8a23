#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"
#include "cli/command_line.h"
#include "cli/options/scene.h"
#include "cli/provenance.h"
#include "control/plant/linear_design.h"

namespace faba::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kUm = 1e6, kMs = 1e3, kDegrees = 180 / std::numbers::pi;

/// A pole of the sampled loop, and the continuous motion that it stands for.
struct Mode {
  std::complex<double> pole;
  double time_constant = 0;  ///< s
  double frequency = 0;      ///< Hz; 0: no oscillation
  double damping = 1;        ///< ratio
};
Mode mode_of(std::complex<double> pole, double period) {
  Mode m{pole};
  const std::complex<double> s = std::log(pole) / period;
  m.time_constant = -1 / s.real();
  m.frequency = std::abs(s.imag()) / (2 * std::numbers::pi);
  m.damping = -s.real() / std::abs(s);
  return m;
}

struct Design {
  LqrDesign design;
  int delay = 0;  ///< frames
  Margins margins;
  std::vector<Mode> modes;
};

Design design_of(const Scenario& s) {
  Pool pool(1);
  const Simulation simulation(s, 1, pool);
  const LqrDesign* d = simulation.controller().design();
  if (!d)
    throw Error(
        Errc::usage, "controller.type",
        fmt::format(
            "\"{}\" has no gains that are designed from the plant; add --set 'controller={{type=\"lqr\"}}'",
            s.controller.type));
  if (!(d->position > 0))
    throw Error(Errc::usage, "swarm[0].model",
                "no field moves this swarm, so that there is no design; use cells that swim and respond");
  Design out{*d, int(std::lround(simulation.control().delay_frames)), {}, {}};
  out.margins = margins_of(*d, out.delay);
  for (const std::complex<double> pole : d->poles) out.modes.push_back(mode_of(pole, d->period));
  return out;
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json design_json(const Design& o) {
  const LqrDesign& d = o.design;
  Json poles = Json::array();
  for (const Mode& m : o.modes)
    poles.push_back({{"re", m.pole.real()},
                     {"im", m.pole.imag()},
                     {"time_constant_s", number(m.time_constant)},
                     {"frequency_hz", m.frequency},
                     {"damping", m.damping}});
  return {{"plant",
           {{"immediate", d.plant.immediate},
            {d.plant.immediate ? "speed_um_per_s" : "acceleration_um_per_s2", kUm * d.plant.gain},
            {"rate_per_s", d.plant.rate}}},
          {"frame_period_s", d.period},
          {"delay_frames", o.delay},
          {"gains",
           {{"position_per_um", d.position / kUm},
            {"velocity_s_per_um", d.velocity / kUm},
            {"integral_per_um_s", d.integral / kUm}}},
          {"poles", poles},
          {"gain_margin", number(o.margins.gain)},
          {"phase_margin_deg", number(kDegrees * o.margins.phase)},
          {"delay_margin_s", number(o.margins.delay)}};
}

void print_design(const Design& o) {
  const LqrDesign& d = o.design;
  if (d.plant.immediate)
    fmt::print("plant    the full command moves the swarm at {:.4g} um/s at once\n", kUm * d.plant.gain);
  else
    fmt::print(
        "plant    the full command accelerates a slow swarm by {:.4g} um/s^2; without a command its "
        "velocity\n         decays with a time constant of {:.3g} s\n",
        kUm * d.plant.gain, 1 / d.plant.rate);
  fmt::print("gains    command = -({:.4g} /um position error", d.position / kUm);
  if (d.velocity != 0) fmt::print(" + {:.4g} s/um velocity", d.velocity / kUm);
  if (d.integral != 0) fmt::print(" + {:.4g} /(um s) integral of the error", d.integral / kUm);
  fmt::print("), a fraction of the full command\n");
  for (const Mode& m : o.modes) {
    fmt::print("pole     {:.4f}{:+.4f}i per frame: time constant {:.3g} ms", m.pole.real(), m.pole.imag(),
               kMs * m.time_constant);
    if (m.frequency > 0) fmt::print(", {:.3g} Hz, damping ratio {:.2f}", m.frequency, m.damping);
    fmt::print("\n");
  }
  const auto finite = [](double v, const char* unit) {
    return std::isfinite(v) ? fmt::format("{:.3g}{}", v, unit) : std::string("unlimited");
  };
  fmt::print("margins  gain {}, phase {}, additional delay {} ({} frames); {}\n",
             finite(o.margins.gain, " times"), finite(kDegrees * o.margins.phase, " deg"),
             finite(kMs * o.margins.delay, " ms"), finite(o.margins.delay / d.period, ""),
             o.delay == 0 ? std::string("the camera has no delay")
                          : fmt::format("the camera delay of {} frames is predicted", o.delay));
}

int design(const SceneOptions& v, const Common& c) {
  const Scenario s = read_scenario(read_scene(v), builtin_parts());
  const Design found = design_of(s);
  if (c.json) print_json(design_json(found), provenance_of(c, {v.scene}));
  if (!c.json && !c.quiet) print_design(found);
  return 0;
}

}  // namespace

void add_design(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<SceneOptions>();
  CLI::App* v =
      verb(app, line, "design", "Gains, poles and stability margins of the controller of a scenario",
           "  faba design scenes/bench.toml --set 'controller={type=\"lqr\"}'\n"
           "  faba design scenes/bench.toml --set 'controller={type=\"lqr\",error_px=5}' --json");
  v->add_option("scene", o->scene, "Scenario file (TOML)")->required();
  v->add_option("--set", o->set, "Set one value of the scenario: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->callback([o, &line] { line.code = design(*o, line.common); });
}

}  // namespace faba::cli
