#include "study/pages/steering/design_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "core/units.h"

namespace faba {
namespace {

constexpr double kUmPerM = 1e6, kMsPerS = 1e3;

Json finite_or_null(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

}  // namespace

nlohmann::ordered_json design_json(const LoopDesign& o) {
  const LqrDesign& d = o.design;
  Json poles = Json::array();
  for (const LoopMode& m : o.modes)
    poles.push_back({{"re", m.pole.real()},
                     {"im", m.pole.imag()},
                     {"time_constant_s", finite_or_null(m.time_constant)},
                     {"frequency_hz", m.frequency},
                     {"damping", m.damping}});
  return {{"plant",
           {{"immediate", d.plant.immediate},
            {d.plant.immediate ? "speed_um_per_s" : "acceleration_um_per_s2", kUmPerM * d.plant.gain},
            {"rate_per_s", d.plant.rate}}},
          {"frame_period_s", d.period},
          {"delay_frames", o.delay},
          {"gains",
           {{"position_per_um", d.position / kUmPerM},
            {"velocity_s_per_um", d.velocity / kUmPerM},
            {"integral_per_um_s", d.integral / kUmPerM}}},
          {"poles", poles},
          {"gain_margin", finite_or_null(o.margins.gain)},
          {"phase_margin_deg", finite_or_null(kDegreesPerRadian * o.margins.phase)},
          {"delay_margin_s", finite_or_null(o.margins.delay)},
          {"notes", o.notes}};
}

std::string design_text(const LoopDesign& o) {
  std::string out;
  const LqrDesign& d = o.design;
  if (d.plant.immediate)
    out += fmt::format("plant    the full command moves the swarm at {:.4g} um/s at once\n",
                       kUmPerM * d.plant.gain);
  else
    out += fmt::format(
        "plant    the full command accelerates a slow swarm by {:.4g} um/s^2; without a command its "
        "velocity\n         decays with a time constant of {:.3g} s\n",
        kUmPerM * d.plant.gain, 1 / d.plant.rate);
  out += fmt::format("gains    command = -({:.4g} /um position error", d.position / kUmPerM);
  if (d.velocity != 0) out += fmt::format(" + {:.4g} s/um velocity", d.velocity / kUmPerM);
  if (d.integral != 0) out += fmt::format(" + {:.4g} /(um s) integral of the error", d.integral / kUmPerM);
  out += fmt::format("), a fraction of the full command\n");
  for (const LoopMode& m : o.modes) {
    out += fmt::format("pole     {:.4f}{:+.4f}i per frame: time constant {:.3g} ms", m.pole.real(),
                       m.pole.imag(), kMsPerS * m.time_constant);
    if (m.frequency > 0) out += fmt::format(", {:.3g} Hz, damping ratio {:.2f}", m.frequency, m.damping);
    out += fmt::format("\n");
  }
  const auto finite = [](double v, const char* unit) {
    return std::isfinite(v) ? fmt::format("{:.3g}{}", v, unit) : std::string("unlimited");
  };
  out += fmt::format("margins  gain {}, phase {}, additional delay {} ({} frames); {}\n",
                     finite(o.margins.gain, " times"), finite(kDegreesPerRadian * o.margins.phase, " deg"),
                     finite(kMsPerS * o.margins.delay, " ms"), finite(o.margins.delay / d.period, ""),
                     o.delay == 0 ? std::string("the camera has no delay")
                                  : fmt::format("the camera delay of {} frames is predicted", o.delay));
  return out;
}

}  // namespace faba
