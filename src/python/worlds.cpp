#include "python/worlds.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "app/sinks/drawn_swarm.h"
#include "core/random/distributions.h"
#include "core/random/draw_blocks.h"
#include "python/convert.h"

namespace faba::python {
namespace {

// Observations are limited, in units of half the view's height, so that no policy meets an extreme value.
constexpr double kMostObserved = 10;

float observed(double v) {
  return std::isfinite(v) ? float(std::clamp(v, -kMostObserved, kMostObserved)) : 0.0f;
}

double half_height(const ControlContext& c) { return 0.5 * c.frame.height * c.scale.m_per_px; }

Vec2 true_centroid(const State& s) {
  const auto x = s.agents["x"], y = s.agents["y"];
  Vec2 sum;
  for (std::size_t i = 0; i < x.size(); ++i) sum = sum + Vec2{double(x[i]), double(y[i])};
  return (1 / double(std::max<std::size_t>(x.size(), 1))) * sum;
}

// Root-mean-square distance of the cells from their centroid, m.
double true_radius(const State& s, Vec2 c) {
  const auto x = s.agents["x"], y = s.agents["y"];
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec2 d = Vec2{double(x[i]), double(y[i])} - c;
    sum += dot(d, d);
  }
  return std::sqrt(sum / double(std::max<std::size_t>(x.size(), 1)));
}

}  // namespace

void PolicyInput::fill(float* to, const ControlContext& c, const Estimate& e, const Target& target,
                       const Command& last) {
  const double length = half_height(c);
  const double values[kFixed] = {e.centroid.x / length,
                                 e.centroid.y / length,
                                 target.position.x / length,
                                 target.position.y / length,
                                 e.velocity.x / length,
                                 e.velocity.y / length,
                                 std::sqrt(std::max(0.0, e.cov.xx)) / length,
                                 std::sqrt(std::max(0.0, e.cov.yy)) / length,
                                 double(e.visible > 0)};
  for (const double v : values) *to++ = observed(v);
  for (std::size_t k = 0; k < c.max_current.size(); ++k)
    *to++ = k < last.current.size() ? observed(last.current[k] / c.max_current[k]) : 0.0f;
}

Command PolicyOutput::command(const ControlContext& c, Vec2 centroid, const double* action) const {
  if (!currents) return field_command(c, centroid, {strength * action[0], strength * action[1]});
  Command command{c.max_current};
  for (std::size_t k = 0; k < command.current.size(); ++k) command.current[k] *= action[k];
  return command;
}

Worlds::Worlds(Document scene, std::size_t number, unsigned threads, PolicyOutput output, double noise_px)
    : scene_(std::move(scene)),
      output_(output),
      noise_px_(noise_px),
      parts_(builtin_parts()),
      pool_(unsigned(std::min<std::size_t>(number_of_threads(threads), number))),
      worlds_(number) {}

void Worlds::begin(World& w) const {
  if (!begin_cycle(w.simulation->loop(), w.cycle))
    throw Error(Errc::internal, "worlds", "the camera stopped");
  look(w);
}

// What Python gets of a world. Here, because this thread has its cells in the cache.
void Worlds::look(World& w) const {
  const ControlContext& c = w.simulation->control();
  const State& state = w.simulation->world().state();
  w.input.resize(PolicyInput::size(c));
  Estimate seen = w.cycle.estimate;
  if (noise_px_ > 0) {
    const auto bits = draw(*w.scenario->params.seed, kPolicyDraws, 0, std::uint32_t(w.cycle.seen.frame));
    const auto noise = [&](std::uint32_t u) {
      return noise_px_ * c.scale.m_per_px * normal_quantile((double(u) + 0.5) * 0x1p-32);
    };
    seen.centroid = seen.centroid + Vec2{noise(bits[0]), noise(bits[1])};
  }
  PolicyInput::fill(w.input.data(), c, seen, w.cycle.target, w.simulation->loop().last);
  w.centroid = true_centroid(state);
  w.radius = true_radius(state, w.centroid);
}

// As step(): a thread has the same worlds, and so their cells in its cache, in each call.
void Worlds::reset(const std::vector<std::size_t>& which, const std::vector<std::uint64_t>& seeds,
                   const std::vector<std::vector<std::pair<std::string, Json>>>& sets) {
  pool_.run(which.size(), [&](std::size_t k) {
    Document d = scene_;
    for (const auto& [path, value] : sets[k]) set_value(d, path, value, "sets");
    d.set("seed", Json(seeds[k]), "seed");
    World w;  // replaces the former one when it is complete
    w.pool = std::make_unique<Pool>(1);
    w.scenario = std::make_unique<Scenario>(read_scenario_with(std::move(d), parts_));
    w.simulation = std::make_unique<Simulation>(*w.scenario, seeds[k], *w.pool);
    begin(w);
    worlds_.at(which[k]) = std::move(w);
  });
}

void Worlds::step(const double* actions) {
  const std::size_t n = outputs();
  pool_.run(worlds_.size(), [&](std::size_t i) {
    World& w = worlds_[i];
    if (w.finished) return;
    end_cycle(w.simulation->loop(), w.cycle,
              output_.command(w.simulation->control(), w.cycle.estimate.centroid, actions + i * n));
    w.finished = w.simulation->loop().next == w.scenario->frames();
    w.finished ? look(w) : begin(w);
  });
}

namespace {

/// The worlds and the arrays that Python gets after a step.
class PyWorlds {
 public:
  PyWorlds(const py::object& scene, std::size_t number, unsigned threads, const py::object& set,
           const py::object& duration, const std::string& action, double strength, double noise_px)
      : worlds_(read_document({scene, py::none(), set, duration, {}}), checked(number),
                checked_threads(threads), {currents(action), strength}, noise_px) {
    if (!(noise_px >= 0 && noise_px < 1e6))
      throw Error(Errc::usage, "noise_px", fmt::format("{} is not between 0 and 1e6", noise_px));
    exclusive_.threads = worlds_.pool().threads();
  }

  void reset(const std::vector<std::size_t>& which, const std::vector<std::uint64_t>& seeds,
             const py::list& sets) {
    const InUse use(exclusive_);
    if (which.size() != seeds.size() || which.size() != sets.size())
      throw Error(Errc::usage, "reset", "which, seeds and sets have different lengths");
    std::vector<bool> named(worlds_.all().size());
    for (const std::size_t i : which) {
      if (i >= named.size() || named[i])
        throw Error(Errc::usage, "reset",
                    fmt::format("there is no world {}, or it is named twice; there are {}", i, named.size()));
      named[i] = true;
    }
    std::vector<std::vector<std::pair<std::string, Json>>> changes(sets.size());
    for (std::size_t k = 0; k < sets.size(); ++k)
      for (const auto& [path, value] : py::reinterpret_borrow<py::dict>(sets[k])) {
        const auto name = py::str(path).cast<std::string>();
        changes[k].emplace_back(name, json_of(value, name));
      }
    raised_.run([&] { worlds_.reset(which, seeds, changes); });
    started_ = started_ || which.size() == worlds_.all().size();
    if (!started_) throw Error(Errc::usage, "reset", "the first reset must be of all worlds");
  }

  void step(const py::array_t<double, py::array::c_style | py::array::forcecast>& actions) {
    const InUse use(exclusive_);
    require_started();
    const auto n = py::ssize_t(worlds_.all().size()), k = py::ssize_t(worlds_.outputs());
    if (actions.ndim() != 2 || actions.shape(0) != n || actions.shape(1) != k)
      throw Error(Errc::usage, "actions", fmt::format("must have the shape ({}, {})", n, k));
    for (py::ssize_t i = 0; i < actions.size(); ++i)
      if (!std::isfinite(actions.data()[i])) throw Error(Errc::usage, "actions", "must be finite");
    std::vector<double> copy(actions.data(), actions.data() + actions.size());
    for (double& a : copy) a = std::clamp(a, -1.0, 1.0);
    raised_.run([&] { worlds_.step(copy.data()); });
  }

  py::array_t<float> observations() {
    const InUse use(exclusive_);
    require_started();
    const std::size_t n = worlds_.all().size(), k = worlds_.inputs();
    py::array_t<float> a({n, k});
    float* to = a.mutable_data();
    for (const Worlds::World& w : worlds_.all()) to = std::copy(w.input.begin(), w.input.end(), to);
    return a;
  }

  template <class Value>
  py::array vectors(Value value) {
    const InUse use(exclusive_);
    require_started();
    py::array_t<double> a({worlds_.all().size(), std::size_t(2)});
    for (std::size_t i = 0; i < worlds_.all().size(); ++i) {
      const Vec2 v = value(worlds_.all()[i]);
      a.mutable_at(i, 0) = v.x;
      a.mutable_at(i, 1) = v.y;
    }
    return a;
  }
  template <class T, class Value>
  py::array numbers(Value value) {
    const InUse use(exclusive_);
    require_started();
    py::array_t<T> a(py::ssize_t(worlds_.all().size()));
    for (std::size_t i = 0; i < worlds_.all().size(); ++i) a.mutable_at(i) = T(value(worlds_.all()[i]));
    return a;
  }

  py::array drawing(std::size_t which) {
    const InUse use(exclusive_);
    require_started();
    if (which >= worlds_.all().size())
      throw Error(Errc::usage, "drawing", fmt::format("there is no world {}", which));
    const Worlds::World& w = worlds_.all()[which];
    DrawnSwarm drawn(w.simulation->world(), w.simulation->loop(), w.scenario->scale.um_per_px);
    RgbImage image;
    drawn.draw(w.cycle.seen.t, w.cycle.target.position, image);
    return py::array_t<std::uint8_t>({image.height, image.width, 3}, &image.px.front().r);
  }

  const Worlds& worlds() const {
    require_started();
    return worlds_;
  }
  std::size_t number() const { return worlds_.all().size(); }

 private:
  static std::size_t checked(std::size_t number) {
    if (number < 1 || number > 100000)
      throw Error(Errc::usage, "number", fmt::format("{} worlds; give 1 to 100000", number));
    return number;
  }
  static bool currents(const std::string& action) {
    if (action == "currents" || action == "field") return action == "currents";
    throw Error(Errc::usage, "action", fmt::format("\"{}\" is not field or currents", action));
  }
  void require_started() const {
    if (!started_) throw Error(Errc::usage, "worlds", "call reset() first");
  }

  Exclusive exclusive_{"Worlds"};
  Raised raised_;
  Worlds worlds_;
  bool started_ = false;
};

// The input of a policy that is a controller.
py::array_t<float> policy_input(const ControlContext& c, const Estimate& e, const Target& target,
                                const py::object& last) {
  py::array_t<float> a(py::ssize_t(PolicyInput::size(c)));
  PolicyInput::fill(a.mutable_data(), c, e, target, {numbers_of(last, "last")});
  return a;
}

}  // namespace

void bind_worlds(py::module_& m) {
  using W = Worlds::World;
  py::class_<PyWorlds>(
      m, "Worlds",
      "Many simulations of a scenario that are stepped together, on all cores.\n\n"
      "scene, set, duration : as of Simulation\nnumber : int\nthreads : int, 0: all\n"
      "action : \"field\", two numbers from -1 to 1 along which the cells swim, or \"currents\", one\n"
      "    number from -1 to 1 for each coil\nstrength : field units of a field action of length 1\n"
      "noise_px : standard deviation of the noise of the observed centroid")
      .def(py::init<const py::object&, std::size_t, unsigned, const py::object&, const py::object&,
                    const std::string&, double, double>(),
           py::arg("scene"), py::arg("number"), py::kw_only(), py::arg("threads") = 0,
           py::arg("set") = py::none(), py::arg("duration") = py::none(), py::arg("action") = "field",
           py::arg("strength") = 5.0, py::arg("noise_px") = 0.0)
      .def("reset", &PyWorlds::reset, py::arg("which"), py::arg("seeds"), py::arg("sets"),
           "Starts worlds again, each with a seed and a dict of changes of the scenario.")
      .def("step", &PyWorlds::step, py::arg("actions"),
           "One control cycle of each world; `actions`: array (worlds, size of an action), limited to -1 to "
           "1.")
      .def_property_readonly("number", &PyWorlds::number, "int: number of worlds")
      .def_property_readonly(
          "inputs", [](const PyWorlds& w) { return w.worlds().inputs(); }, "int: size of an observation")
      .def_property_readonly(
          "outputs", [](const PyWorlds& w) { return w.worlds().outputs(); }, "int: size of an action")
      .def("observations", &PyWorlds::observations,
           "float32 array (worlds, inputs): estimated centroid (2), setpoint (2), velocity (2), standard\n"
           "deviations (2), 1 with visible cells, previous currents; lengths in units of half the view's "
           "height, limited to -10 to 10.")
      .def(
          "true_centroids", [](PyWorlds& w) { return w.vectors([](const W& one) { return one.centroid; }); },
          "float array (worlds, 2): m, world frame")
      .def(
          "true_radii",
          [](PyWorlds& w) { return w.numbers<double>([](const W& one) { return one.radius; }); },
          "float array (worlds,): root-mean-square distance of the cells from their centroid, m")
      .def(
          "true_distances",
          [](PyWorlds& w) {
            return w.numbers<double>(
                [](const W& one) { return norm(one.centroid - one.cycle.target.position); });
          },
          "float array (worlds,): distance of the centroid from the setpoint, m")
      .def(
          "setpoints",
          [](PyWorlds& w) { return w.vectors([](const W& one) { return one.cycle.target.position; }); },
          "float array (worlds, 2): m, world frame")
      .def(
          "setpoint_indices",
          [](PyWorlds& w) {
            return w.numbers<std::int64_t>([](const W& one) { return one.cycle.target.index; });
          },
          "int array (worlds,): index of the setpoint on a route")
      .def(
          "routes_finished",
          [](PyWorlds& w) { return w.numbers<bool>([](const W& one) { return one.cycle.target.finished; }); },
          "bool array (worlds,): whether the end of the route is reached")
      .def(
          "finished", [](PyWorlds& w) { return w.numbers<bool>([](const W& one) { return one.finished; }); },
          "bool array (worlds,): whether all frames of the scenario are simulated")
      .def_property_readonly(
          "half_height",
          [](const PyWorlds& w) { return half_height(w.worlds().all().front().simulation->control()); },
          "float: half the height of the view, m")
      .def("drawing", &PyWorlds::drawing, py::arg("world"),
           "The schematic picture of the lab, uint8 array (height, width, 3).");
  m.def("policy_input", policy_input, py::arg("context"), py::arg("estimate"), py::arg("target"),
        py::arg("last"), "The observation of Worlds for a controller; `last`: previous currents, A.");
}

}  // namespace faba::python
