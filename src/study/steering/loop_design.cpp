#include "study/steering/loop_design.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/run/notes.h"
#include "app/run/simulation.h"

namespace faba {
namespace {

LoopMode mode_of(std::complex<double> pole, double period) {
  LoopMode m{pole};
  const std::complex<double> s = std::log(pole) / period;
  m.time_constant = -1 / s.real();
  m.frequency = std::abs(s.imag()) / (2 * std::numbers::pi);
  m.damping = -s.real() / std::abs(s);
  return m;
}

}  // namespace

LoopDesign loop_design(const Scenario& s) {
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
  const double age = s.camera.delay_frames * s.frame_period();
  if (age > s.limits.max_frame_age)
    throw Error(
        Errc::usage, "camera.delay_frames",
        fmt::format("{}: every picture is {:.3g} s old, more than limits.max_frame_age = {:g} s, and all "
                    "currents are zero; reduce the delay",
                    s.camera.delay_frames, age, s.limits.max_frame_age));
  LoopDesign out{*d,
                 int(std::lround(simulation.control().delay_frames)),
                 {},
                 {},
                 scenario_notes(s, simulation, std::filesystem::current_path())};
  out.margins = margins_of(*d, out.delay);
  for (const std::complex<double> pole : d->poles) out.modes.push_back(mode_of(pole, d->period));
  return out;
}

}  // namespace faba
