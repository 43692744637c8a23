#include "app/run/simulation.h"

#include <fmt/format.h>

#include <cmath>

#include "app/scenario/rig_file.h"
#include "field/library.h"

namespace faba {
namespace {

// Maximum in-plane field of the coils in the arena, T.
double maximum_field(const WorldParts& w, double max_current) {
  const std::vector<double> limits = w.field->max_currents(max_current);
  if (w.table) return w.table->strongest(limits);
  std::vector<Vec3> b(w.field->coils());
  w.field->basis({}, b, {});
  const Vec3 earth = w.field->ambient();
  Vec2 sum{std::fabs(earth.x), std::fabs(earth.y)};
  for (std::size_t k = 0; k < b.size(); ++k)
    sum = sum + Vec2{limits[k] * std::fabs(b[k].x), limits[k] * std::fabs(b[k].y)};
  return norm(sum);
}

// Field table on the bounding rectangle of the arena, or at the nodes of a library, which must cover it.
FieldTable tabulated(const Field& field, const Grid& g, const FieldLibrary* library, const Scenario& s) {
  const Vec2 low{double(g.left), double(g.low)};
  const Vec2 high = low + double(g.cell) * Vec2{double(g.columns), double(g.rows)};
  if (!library) return {field, low, high};
  const Vec2 from = library->grid().low, to = library->grid().high();
  constexpr double kRim = 1e-9;  // m
  if (low.x < from.x - kRim || low.y < from.y - kRim || high.x > to.x + kRim || high.y > to.y + kRim)
    throw Error(
        Errc::usage, "library",
        fmt::format(
            "the library covers {:.4g} x {:.4g} mm, but the arena is {:.4g} x {:.4g} mm; create a larger "
            "library with --size",
            1e3 * (to - from).x, 1e3 * (to - from).y, 1e3 * (high - low).x, 1e3 * (high - low).y));
  return library->table(field, coil_system_hash(s.field.resolved));
}

constexpr double kJitterSteps =
    4;  // steps per standard deviation of the jitter, so that rounding is invisible

// Steps per frame: given by the user, or the minimum for the accuracy of every model, with an integer number
// of steps per iteration.
int steps_per_frame(const Scenario& s, double longest) {
  const double frame = s.frame_period();
  if (s.camera.jitter > 0) longest = std::min(longest, s.camera.jitter / kJitterSteps);
  if (s.simulation.step) {
    if (s.camera.jitter > 0 && *s.simulation.step > s.camera.jitter)
      throw Error(
          Errc::usage, "camera.jitter",
          fmt::format(
              "{:g} s is less than a time step ({:g} s), but frames are taken at multiples of a step; "
              "reduce simulation.step",
              s.camera.jitter, *s.simulation.step));
    const double n = frame / *s.simulation.step, steps = std::floor(n + 0.5);
    if (steps < 1 || std::fabs(n - steps) > 1e-6 * steps)
      throw Error(
          Errc::usage, "simulation.step",
          fmt::format("{:g} s does not divide the frame period ({:g} s); the nearest valid step is {:.9g} s",
                      *s.simulation.step, frame, frame / std::max(1.0, steps)));
    return int(steps);
  }
  const double needed = std::max(1.0, std::ceil(frame / longest - 1e-9));
  if (!(needed < 1e9))
    throw Error(
        Errc::usage, "simulation",
        fmt::format("the models need {:.2g} steps per frame for their accuracy; use a weaker field, slower "
                    "turning or less diffusion, or set simulation.step",
                    needed));
  const int min_steps = int(needed);
  const double iteration = s.si_scale().iteration;
  for (int n = min_steps; n <= min_steps + 3 + int(std::ceil(frame / iteration)); ++n) {
    const double per_iteration = iteration * n / frame;
    if (per_iteration > 0.5 && std::fabs(per_iteration - std::floor(per_iteration + 0.5)) < 1e-6) return n;
  }
  return min_steps;  // models that use iterations will report the error
}

std::unique_ptr<SimRig> make_rig(const Scenario& s, World& world, int steps, std::uint64_t seed, Pool& pool,
                                 const VideoBackground* ground) {
  SimRig::Params p{steps, s.frame_period(), s.camera.delay_frames, s.camera.jitter};
  p.frames = s.camera.sensor == CameraParams::Sensor::frames;
  if (s.renders()) {
    const auto read = ground ? nullptr : s.ground();
    const Outline edge = world.parts().arena->outline();
    p.microscope = std::make_shared<Microscope>(s.microscope, world.parts().arena->frame(),
                                                Circle{edge.centre_image, edge.radius_px}, s.frame_period(),
                                                seed, ground ? ground : read.get());
    p.pool = &pool;
  }
  return std::make_unique<SimRig>(world, p);
}

// Each swarm is a range of rows of the state, in the order of the scenario.
void add_populations(WorldParts& w, const Scenario& s) {
  std::size_t at = 0;
  for (const Swarm& swarm : s.swarms) {
    Population p;
    p.begin = at;
    p.end = at += std::size_t(swarm.params.count);
    p.polarity = swarm.params.polarity == Swarm::Polarity::north ? 1 : -1;
    p.responding = swarm.params.responding;
    p.heading = swarm.params.heading;
    p.model = swarm.model.make({s.si_scale(), w.dt});
    p.start = swarm.start.make({w.arena.get()});
    w.populations.push_back(std::move(p));
  }
}

}  // namespace

ControlContext control_context(const Scenario& s, const std::shared_ptr<const Field>& field,
                               const Frame& frame, const std::shared_ptr<const FieldLibrary>& library) {
  ControlContext c{field,
                   s.si_scale(),
                   frame,
                   s.polarity(),
                   s.frame_period(),
                   double(s.camera.delay_frames),
                   field->max_currents(s.limits.max_current),
                   library};
  const Scale scale = s.si_scale();
  if (!s.swarms.empty()) c.motion = s.swarms.front().model.make({scale, scale.iteration})->motion();
  c.max_slew = s.limits.max_slew;
  const Outline edge = s.arena.make({scale})->outline();
  if (edge.radius_px > 0)
    c.drop = Disc{frame.world_from_image(edge.centre_image), edge.radius_px * scale.m_per_px};
  return c;
}

struct Simulation::Exchanged {
  std::unique_ptr<Estimator> estimator;
  std::unique_ptr<Reference> reference;
  std::unique_ptr<Controller> controller;
  std::shared_ptr<const AgentModel> model;
};

Simulation::Simulation(const Scenario& s, std::uint64_t seed, Pool& pool,
                       const std::shared_ptr<const VideoBackground>& ground)
    : events_(s.events) {
  const Scale scale = s.si_scale();
  WorldParts w;
  w.seed = seed;
  w.exclusion = s.exclusion;
  w.arena = s.arena.make({scale});
  w.field = s.field.make({});
  const std::shared_ptr<const FieldLibrary> library = s.field_library();
  if (library || w.field->varies()) w.table = tabulated(*w.field, w.arena->grid(), library.get(), s);
  w.motility = s.motility.make({w.arena.get(), s.params.exposure});
  frame_ = w.arena->frame();

  // The longest step of a model is needed before the step is known: construct it twice, which is cheap.
  double longest = std::min(s.frame_period(), s.simulation.longest);
  strongest_t_ = maximum_field(w, s.limits.max_current);
  const auto shorten = [&](const ModelRegistry::PartType& model) {
    longest = std::min(longest, model.make({scale, scale.iteration})->longest_step(strongest_t_));
  };
  for (const Swarm& swarm : s.swarms) shorten(swarm.model);
  for (const Event& e : s.events)
    if (e.model) shorten(*e.model);
  const int steps = steps_per_frame(s, longest);
  w.dt = s.frame_period() / steps;

  add_populations(w, s);
  if (double(s.frames()) * steps > 4e9)
    throw Error(
        Errc::usage, "duration",
        fmt::format(
            "the run has more than 4e9 steps of {:g} s, the length of a random stream; reduce the duration",
            w.dt));

  limits_ = Limits(s.limits, w.field->max_currents(s.limits.max_current));
  control_ = control_context(s, w.field, frame_, library);
  world_ = std::make_unique<World>(std::move(w), pool);
  rig_ = make_rig(s, *world_, steps, seed, pool, ground.get());
  estimator_ = s.estimator.make(control_);
  reference_ = s.reference.make(control_);
  controller_ = s.controller.make(control_);
  loop_ = std::make_unique<Loop>(Loop{.rig = *rig_,
                                      .estimator = estimator_.get(),
                                      .reference = reference_.get(),
                                      .controller = controller_.get(),
                                      .limits = limits_,
                                      .frame_period = s.frame_period(),
                                      .sinks = {},
                                      .between = [this] { apply_due(loop_->next + 1); },
                                      .last = {}});
  for (const Event& e : events_) make(e);  // throws for unsuitable parts before the run starts
}

Simulation::Exchanged Simulation::make(const Event& e) const {
  Exchanged parts;
  if (e.estimator) parts.estimator = e.estimator->make(control_);
  if (e.reference) parts.reference = e.reference->make(control_);
  if (e.controller) parts.controller = e.controller->make(control_);
  if (e.model) {
    parts.model = e.model->make({control_.scale, step()});
    if (const double longest = parts.model->longest_step(strongest_t_); longest < step() * (1 - 1e-9))
      throw Error(
          Errc::usage, "model",
          fmt::format(
              "the model needs steps of {:.3g} s, but the run has steps of {:.3g} s; restart the run with "
              "this model, or set simulation.step",
              longest, step()));
  }
  return parts;
}

void Simulation::apply(const Event& e) {
  Exchanged parts = make(e);
  if (parts.estimator) estimator_ = std::move(parts.estimator);
  if (parts.reference) reference_ = std::move(parts.reference);
  if (parts.controller) controller_ = std::move(parts.controller);
  if (parts.model) world_->exchange_model(e.swarm, std::move(parts.model));
  loop_->estimator = estimator_.get();
  loop_->reference = reference_.get();
  loop_->controller = controller_.get();
}

void Simulation::apply_due(std::uint64_t cycles) {
  for (; next_event_ < events_.size() && events_[next_event_].frame < cycles; ++next_event_)
    apply(events_[next_event_]);
}

std::string Simulation::state_hash() const {
  State s = world_->state();
  std::fill(s.command.begin(), s.command.end(), 0.0);
  return s.hash();
}

void Simulation::archive(Archive& a) {
  State state;
  if (a.reading())
    a& state;
  else
    a.write(world_->state());
  a & loop_->next & loop_->last_t & loop_->last.current;
  if (a.reading()) {
    apply_due(loop_->next);  // the state read below is that of the exchanged parts
    world_->restore(state);
  }
  rig_->archive(a);
  estimator_->archive(a);
  reference_->archive(a);
  controller_->archive(a);
  limits_.archive(a);
}

}  // namespace faba
