#include "python/simulation.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/convert.h"

namespace faba::python {
/// Keeps the data of the last cycle.
class PySimulation::Last final : public Sink {
 public:
  void take(const Tick& t) override { tick = std::make_shared<TickCopy>(t); }
  std::shared_ptr<TickCopy> tick;
};

PySimulation::PySimulation(Scenario s, unsigned threads, std::shared_ptr<Raised> raised)
    : scenario_(std::move(s)), raised_(std::move(raised)), pool_(threads) {
  exclusive_.threads = pool_.threads();
  simulation_ = std::make_unique<Simulation>(scenario_, *scenario_.params.seed, pool_);
  last_ = std::make_unique<Last>();
  simulation_->loop().sinks.push_back(last_.get());
}

void PySimulation::finish() {
  if (finished()) simulation_->rig().safe();
}

std::shared_ptr<TickCopy> PySimulation::turn(const std::optional<Command>& command) {
  if (finished())
    throw Error(Errc::usage, "Simulation",
                fmt::format("all {} frames of the scenario are simulated; give a longer duration",
                            scenario_.frames()));
  Loop& loop = simulation_->loop();
  if (CycleInput cycle; !command)
    run_cycle(loop);
  else if (begin_cycle(loop, cycle))
    end_cycle(loop, cycle, *command);
  finish();
  return last_->tick;
}

void PySimulation::run(std::optional<std::uint64_t> end) {
  const std::uint64_t last = std::min(end.value_or(scenario_.frames()), scenario_.frames());
  Loop& loop = simulation_->loop();
  while (loop.next < last && run_cycle(loop))
    if (raised_->stopped()) throw Error(Errc::interrupted, "Simulation", "stopped");
  finish();
}

ImageRef PySimulation::picture() {
  if (!scenario_.renders())
    throw Error(Errc::usage, "Simulation",
                "the scenario renders no pictures; add set={\"record.as_seen\": True}");
  if (!last_->tick)
    throw Error(Errc::usage, "Simulation", "there is no frame yet; call turn() or run() first");
  return simulation_->rig().picture();
}

RgbImage PySimulation::drawing() {
  if (!last_->tick)
    throw Error(Errc::usage, "Simulation", "there is no frame to draw; call turn() or run() first");
  if (!drawn_)
    drawn_ =
        std::make_unique<DrawnSwarm>(simulation_->world(), simulation_->loop(), scenario_.scale.um_per_px);
  RgbImage picture;
  drawn_->draw(last_->tick->seen->t, last_->tick->target.position, picture);
  return picture;
}

std::vector<std::uint8_t> PySimulation::save() {
  Archive a;
  simulation_->archive(a);
  return a.bytes();
}

void PySimulation::restore(const std::vector<std::uint8_t>& saved) {
  Archive a(saved);
  simulation_->archive(a);
  if (!a.at_end()) throw Error(Errc::input, "Simulation", "the saved state belongs to another scenario");
}

namespace {

std::shared_ptr<PySimulation> make(const py::object& scene, const py::object& seed, const py::object& set,
                                   unsigned threads, const py::object& duration, const py::object& controller,
                                   const py::object& estimator, const py::object& reference) {
  const auto raised = std::make_shared<Raised>();
  Scenario s = read_scene({scene, seed, set, duration, {estimator, reference, controller}}, raised);
  std::shared_ptr<PySimulation> made;
  raised->run([&] { made = std::make_shared<PySimulation>(std::move(s), checked_threads(threads), raised); });
  return made;
}

std::shared_ptr<TickCopy> turn(PySimulation& s, const py::object& command) {
  const InUse use(s.exclusive());
  std::optional<Command> given;
  if (!command.is_none()) given = Command{numbers_of(command, "command")};
  std::shared_ptr<TickCopy> tick;
  s.raised().run([&] { tick = s.turn(given); });
  return tick;
}

py::object run(const py::object& self, const py::object& frames) {
  auto& s = self.cast<PySimulation&>();
  const InUse use(s.exclusive());
  std::optional<std::uint64_t> end;
  if (!frames.is_none()) {
    const Json n = json_of(frames, "frames");
    if (!n.is_number_integer() || n < 0)
      throw Error(Errc::usage, "frames",
                  fmt::format("is {}; give a number of frames, an integer from 0", n.dump()));
    end = s.frame() + n.get<std::uint64_t>();
  }
  s.raised().run([&] { s.run(end); });
  return self;
}

py::dict state(const py::object& self) {
  auto& s = self.cast<PySimulation&>();
  const InUse use(s.exclusive());
  py::dict columns;
  for (const Column& c : s.simulation().world().state().agents.all())
    columns[py::str(c.name)] =
        view_of(c.data.data(), {py::ssize_t(c.data.size())}, {py::ssize_t(sizeof(float))}, self);
  return columns;
}

py::object picture(PySimulation& s) {
  const InUse use(s.exclusive());
  ImageRef image;
  s.raised().run([&] { image = s.picture(); });
  auto* kept = new ImageRef(image);
  const py::capsule owner(kept, [](void* p) { delete static_cast<ImageRef*>(p); });
  return view_of(image->px.data(), {image->height, image->width}, {image->width, 1}, owner);
}

py::object drawing(PySimulation& s) {
  const InUse use(s.exclusive());
  RgbImage image;
  s.raised().run([&] { image = s.drawing(); });
  return py::array_t<std::uint8_t>({image.height, image.width, 3}, &image.px.front().r);
}

std::string state_hash(PySimulation& s) {
  const InUse use(s.exclusive());
  return s.simulation().state_hash();
}

py::bytes save(PySimulation& s) {
  const InUse use(s.exclusive());
  std::vector<std::uint8_t> bytes;
  s.raised().run([&] { bytes = s.save(); });
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void restore(PySimulation& s, const py::bytes& saved) {
  const InUse use(s.exclusive());
  const std::string_view text = saved;
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  s.raised().run([&] { s.restore(bytes); });
}

void bind_properties(py::class_<PySimulation, std::shared_ptr<PySimulation>>& c) {
  c.def_property_readonly("frame", &PySimulation::frame, "int: number of simulated frames")
      .def_property_readonly(
          "frames", [](const PySimulation& s) { return s.scenario().frames(); },
          "int: number of frames of the scenario")
      .def_property_readonly("finished", &PySimulation::finished,
                             "bool: whether all frames of the scenario are simulated")
      .def_property_readonly(
          "t", [](const PySimulation& s) { return s.simulation().world().state().t; },
          "float: time of the state, s")
      .def_property_readonly(
          "seed", [](const PySimulation& s) { return *s.scenario().params.seed; },
          "int: seed of the random numbers")
      .def_property_readonly(
          "cells", [](const PySimulation& s) { return s.simulation().world().state().agents.size(); },
          "int: number of cells")
      .def_property_readonly(
          "currents", [](const PySimulation& s) { return array_of(s.simulation().world().state().current); },
          "float array (coils,): current in each coil, A")
      .def_property_readonly(
          "context", [](const PySimulation& s) { return s.simulation().control(); },
          "Context: what controllers know about the experiment")
      .def_property_readonly(
          "scenario", [](const PySimulation& s) { return object_of(s.scenario().resolved()); },
          "dict: the scenario with all defaults")
      .def_property_readonly(
          "scenario_hash", [](const PySimulation& s) { return s.scenario().hash(); },
          "str: hash of everything that affects the result")
      .def_property_readonly(
          "state", state,
          "dict of float32 arrays (cells,): read-only views of the true state of the cells; "
          "`x` and `y` in m,\nworld frame. They change while the simulation runs; use "
          ".copy() to keep values.")
      .def_property_readonly(
          "state_hash", state_hash,
          "str: hash of the state with the coils de-energised; equal to that of `faba run`");
}

}  // namespace

void bind_simulation(py::module_& m) {
  py::class_<PySimulation, std::shared_ptr<PySimulation>> c(
      m, "Simulation",
      "A simulation of a scenario, frame by frame, without files.\n\n"
      "scene : path, TOML text or dict\nseed : int, default: that of the scenario, else random\n"
      "set : dict from paths such as \"swarm[0].count\" to values\nthreads : int, 0: all; does not change "
      "the "
      "result\nduration : s, or text with a unit\n"
      "controller, estimator, reference : an object or a class in Python, the name of a built-in part, or a "
      "table\n    of its type and parameters\n\nThe same scene and seed give the same state hash as `faba "
      "run`.");
  c.def(py::init(&make), py::arg("scene"), py::kw_only(), py::arg("seed") = py::none(),
        py::arg("set") = py::none(), py::arg("threads") = 1, py::arg("duration") = py::none(),
        py::arg("controller") = py::none(), py::arg("estimator") = py::none(),
        py::arg("reference") = py::none())
      .def("turn", turn, py::arg("command") = py::none(),
           "One control cycle: camera, estimator, reference, controller, limits, coils.\n\n"
           "command : currents, A, one for each coil, in place of those of the controller; they pass the "
           "limits.\nReturns a Tick.")
      .def("run", run, py::arg("frames") = py::none(),
           "Simulates a number of frames, default: to the end of the scenario; at most to its end. Returns "
           "the "
           "simulation.")
      .def("picture", picture,
           "The camera's picture of the newest frame, uint8 array (height, width); the scenario must render "
           "pictures:\n"
           "camera.sensor = \"frames\" or record.as_seen = true.")
      .def("drawing", drawing, "The schematic picture of the lab, uint8 array (height, width, 3).")
      .def("save", save, "The complete state of the simulation, bytes.")
      .def("restore", restore, py::arg("saved"), "Continues from a saved state of the same scenario.")
      .def("__repr__", [](const PySimulation& s) {
        return fmt::format("<faba.Simulation \"{}\", frame {} of {}>", s.scenario().params.title, s.frame(),
                           s.scenario().frames());
      });
  bind_properties(c);
}

}  // namespace faba::python
