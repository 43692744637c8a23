#include "app/bench/bench_controls.h"

#include <algorithm>

#include "app/run/simulation.h"

namespace faba {

std::vector<double> permitted_currents(const Scenario& s) {
  if (!s.rig) throw Error(Errc::usage, "rig", "the table [rig] is missing; add it, as in scenes/bench.toml");
  std::vector<double> most = s.field.make({})->max_currents(s.limits.max_current);
  const std::vector<double> wired = s.rig->max_current();
  for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::min(most[k], wired[k]);
  return most;
}

BenchControls::BenchControls(const Scenario& s) : limits(s.limits) {
  const std::vector<double> max_currents = permitted_currents(s);
  if (!s.events.empty())
    throw Error(Errc::usage, "event", "a run on a bench cannot exchange parts; remove [[event]]");
  field = s.field.make({});
  frame = s.arena.make({s.si_scale()})->frame();
  ControlContext control = control_context(s, field, frame, nullptr);
  control.delay_frames = s.rig->params.delay.value_or(0) / s.frame_period();
  Limits::Params p = s.limits;
  if (const auto slew = s.rig->guard.max_slew) p.max_slew = std::min(*slew, p.max_slew.value_or(*slew));
  control.max_slew = p.max_slew;
  control.max_current = max_currents;
  estimator = s.estimator.make(control);
  reference = s.reference.make(control);
  controller = s.controller.make(control);
  const CoilWiring wiring(s.rig->coils);
  std::function<void(std::vector<double>&)> shared_outputs;
  if (wiring.channels().size() < wiring.coils().size())
    shared_outputs = [wiring](std::vector<double>& current) {
      current = wiring.currents(wiring.volts(current));
    };
  limits = Limits(p, max_currents, shared_outputs);
}

Loop BenchControls::loop(Rig& rig, double frame_period) {
  return {.rig = rig,
          .estimator = estimator.get(),
          .reference = reference.get(),
          .controller = controller.get(),
          .limits = limits,
          .frame_period = frame_period,
          .sinks = {},
          .between = {},
          .last = {}};
}

}  // namespace faba
