#include "python/loop_values.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "field/allocate.h"
#include "python/convert.h"
#include "vision/image/image.h"

namespace faba::python {
namespace {

py::array_t<double> matrix_of(const Mat2& m) {
  py::array_t<double> a({2, 2});
  a.mutable_at(0, 0) = m.xx;
  a.mutable_at(0, 1) = a.mutable_at(1, 0) = m.xy;
  a.mutable_at(1, 1) = m.yy;
  return a;
}

Mat2 covariance_of(py::handle value) {
  const auto a = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(
      py::reinterpret_borrow<py::object>(value));
  if (!a) PyErr_Clear();
  if (!a || a.ndim() != 2 || a.shape(0) != 2 || a.shape(1) != 2)
    throw Error(Errc::usage, "cov", "is not a matrix; give an array of the shape (2, 2), m^2");
  return {a.at(0, 0), 0.5 * (a.at(0, 1) + a.at(1, 0)), a.at(1, 1)};
}

Estimate make_estimate(double t, py::handle centroid, double visible, py::handle cov, py::handle velocity) {
  Estimate e;
  e.t = t;
  e.centroid = vector_of(centroid, "centroid");
  e.visible = visible;
  if (!cov.is_none()) e.cov = covariance_of(cov);
  if (!velocity.is_none()) e.velocity = vector_of(velocity, "velocity");
  return e;
}

// Views of the elements of the observation, which is constant.
py::object positions(const py::object& self) {
  const auto& seen = self.cast<const Observation&>().seen;
  const auto n = py::ssize_t(seen.size());
  return view_of(seen.empty() ? nullptr : &seen.front().x, {n, 2}, {sizeof(Detection), sizeof(float)}, self);
}

py::object in_view(const py::object& self) {
  const auto& seen = self.cast<const Observation&>().seen;
  return view_of(seen.empty() ? nullptr : &seen.front().in_view, {py::ssize_t(seen.size())},
                 {sizeof(Detection)}, self);
}

py::object image(const py::object& self) {
  const ImageRef& picture = self.cast<const Observation&>().image;
  if (!picture) return py::none();
  return view_of(picture->px.data(), {picture->height, picture->width}, {picture->width, 1}, self);
}

void bind_observation(py::module_& m) {
  py::class_<Observation, std::shared_ptr<Observation>>(
      m, "Observation", "What the camera delivered in one control cycle; constant, so its arrays are views.")
      .def_readonly("frame", &Observation::frame, "int: index of the frame")
      .def_readonly("t", &Observation::t, "float: middle of the exposure, s")
      .def_readonly("age", &Observation::age, "float: s from the exposure until the frame was delivered")
      .def_readonly("coils_off", &Observation::coils_off,
                    "bool: whether the coils were de-energised since the last frame")
      .def_property_readonly("positions", positions,
                             "float32 array (cells, 2): positions, m, world frame; empty with pictures")
      .def_property_readonly("in_view", in_view, "bool array (cells,): whether a cell is in the camera view")
      .def_property_readonly("image", image, "uint8 array (height, width): the picture, or None")
      .def("__repr__", [](const Observation& o) {
        return fmt::format("<faba.Observation frame {}, t {:.4g} s, {} cells>", o.frame, o.t, o.seen.size());
      });
}

void bind_estimate(py::module_& m) {
  py::class_<Group>(m, "Group", "One of several swarms in view.")
      .def_property_readonly(
          "centroid", [](const Group& g) { return array_of(g.centroid); }, "float array (2,): m, world frame")
      .def_readonly("share", &Group::share, "float: fraction of what is in view")
      .def_property_readonly(
          "cov", [](const Group& g) { return matrix_of(g.cov); },
          "float array (2, 2): of the positions, m^2");
  py::class_<Estimate>(m, "Estimate",
                       "Estimated state of the swarm at the time `t`; world frame, SI units.\n\n"
                       "t : float, s\ncentroid : (x, y), m\nvisible : float, number of cells; 0: none, the "
                       "coils are switched off\n"
                       "cov : array (2, 2), m^2, default: zeros\nvelocity : (x, y), m/s, default: zeros")
      .def(py::init(&make_estimate), py::arg("t"), py::arg("centroid"), py::arg("visible"),
           py::arg("cov") = py::none(), py::arg("velocity") = py::none())
      .def_readonly("t", &Estimate::t, "float: s")
      .def_property_readonly(
          "centroid", [](const Estimate& e) { return array_of(e.centroid); },
          "float array (2,): mean position, m; without cells the last known one")
      .def_property_readonly(
          "cov", [](const Estimate& e) { return matrix_of(e.cov); },
          "float array (2, 2): covariance of the positions of the cells, m^2")
      .def_property_readonly(
          "velocity", [](const Estimate& e) { return array_of(e.velocity); }, "float array (2,): m/s")
      .def_readonly("predicted", &Estimate::predicted,
                    "bool: t, centroid and velocity are those of the time at which the command acts")
      .def_property_readonly(
          "centroid_cov", [](const Estimate& e) { return matrix_of(e.centroid_cov); },
          "float array (2, 2): of the error of the centroid, m^2; zeros: not known")
      .def_property_readonly(
          "velocity_cov", [](const Estimate& e) { return matrix_of(e.velocity_cov); },
          "float array (2, 2): of the error of the velocity, m^2/s^2; zeros: not known")
      .def_readonly("visible", &Estimate::visible,
                    "float: number of cells that the estimate is based on; 0: none")
      .def_readonly("groups", &Estimate::groups, "list of Group: the swarms, if there are several")
      .def("__repr__", [](const Estimate& e) {
        return fmt::format("<faba.Estimate t {:.4g} s, centroid ({:.4g}, {:.4g}) m, {:.0f} cells>", e.t,
                           e.centroid.x, e.centroid.y, e.visible);
      });
}

void bind_target(py::module_& m) {
  py::class_<Target>(m, "Target",
                     "Setpoint of the swarm; world frame, m.\n\n"
                     "position : (x, y), m\nindex : int, of the setpoint on a route\nfinished : bool, "
                     "whether the route is at its end")
      .def(py::init([](py::handle position, std::size_t index, bool finished) {
             return Target{vector_of(position, "position"), index, finished};
           }),
           py::arg("position"), py::arg("index") = 0, py::arg("finished") = false)
      .def_property_readonly(
          "position", [](const Target& t) { return array_of(t.position); },
          "float array (2,): m; NaN: no setpoint")
      .def_readonly("index", &Target::index, "int: index of the setpoint on a route")
      .def_readonly("finished", &Target::finished, "bool: whether the end of the route is reached")
      .def("__repr__", [](const Target& t) {
        return fmt::format("<faba.Target {} ({:.4g}, {:.4g}) m>", t.index, t.position.x, t.position.y);
      });
  py::class_<Drift>(m, "Drift",
                    "Desired mean velocity of the swarm, m/s, world frame: Drift(x, y).\n\n"
                    "The field along it has one field unit for each pixel of drift in an iteration, as cells "
                    "of the models\n"
                    "`basic` and `adapted` need it. Cells of the model `dipole` swim along it at their own "
                    "speed, and turn more\n"
                    "slowly in a weaker field: for them use Context.currents_for_direction().")
      .def(py::init([](double x, double y) {
             return Drift{{x, y}};
           }),
           py::arg("x"), py::arg("y"))
      .def_property_readonly(
          "velocity", [](const Drift& d) { return array_of(d.velocity); }, "float array (2,): m/s")
      .def("__repr__",
           [](const Drift& d) { return fmt::format("faba.Drift({:g}, {:g})", d.velocity.x, d.velocity.y); });
}

void bind_tick(py::module_& m) {
  py::class_<TickCopy, std::shared_ptr<TickCopy>>(m, "Tick", "The data of one control cycle.")
      .def_readonly("index", &TickCopy::index, "int: index of the cycle")
      .def_property_readonly(
          "t", [](const TickCopy& t) { return t.seen->t; }, "float: time of the observation, s")
      .def_property_readonly(
          "observation", [](const TickCopy& t) { return std::const_pointer_cast<Observation>(t.seen); },
          "Observation: what the camera delivered")
      .def_readonly("estimate", &TickCopy::estimate, "Estimate: of the estimator")
      .def_readonly("target", &TickCopy::target, "Target: of the reference")
      .def_property_readonly(
          "command", [](const TickCopy& t) { return array_of(t.command.current); },
          "float array (coils,): currents after the limits, A")
      .def_readonly("limited", &TickCopy::limited, "bool: whether the limits changed the command")
      .def("__repr__",
           [](const TickCopy& t) { return fmt::format("<faba.Tick {}, t {:.4g} s>", t.index, t.seen->t); });
}

void bind_context(py::module_& m) {
  using C = ControlContext;
  py::class_<C>(m, "Context", "What a part of the control loop knows about the experiment.")
      .def_property_readonly(
          "coils", [](const C& c) { return c.max_current.size(); }, "int: number of coils")
      .def_property_readonly(
          "max_currents", [](const C& c) { return array_of(c.max_current); },
          "float array (coils,): largest currents, A")
      .def_readonly("polarity", &C::polarity, "int: of the steered cells; 1 north-seeking, -1 south-seeking")
      .def_readonly("frame_period", &C::frame_period, "float: s")
      .def_readonly("delay_frames", &C::delay_frames, "float: frames from the exposure to the command")
      .def_property_readonly(
          "m_per_px", [](const C& c) { return c.scale.m_per_px; }, "float: size of a pixel, m")
      .def_property_readonly(
          "iteration", [](const C& c) { return c.scale.iteration; }, "float: an iteration of the models, s")
      .def_property_readonly(
          "field_unit", [](const C& c) { return c.scale.field_unit; },
          "float: the unit of the field in the models of the thesis, T")
      .def(
          "currents_for_field",
          [](const C& c, py::handle field, py::handle at) {
            const Vec2 p = vector_of(at, "at");
            return array_of(allocate(*c.field, {p.x, p.y, 0}, vector_of(field, "field")));
          },
          py::arg("field"), py::arg("at") = py::make_tuple(0.0, 0.0),
          "Currents, A, array (coils,), for a field (x, y), T, at a position, m, world frame.\n\n"
          "The ambient field is not compensated.")
      .def(
          "currents_for_direction",
          [](const C& c, py::handle u, py::handle at) {
            return array_of(field_command(c, vector_of(at, "at"), vector_of(u, "u")).current);
          },
          py::arg("u"), py::arg("at") = py::make_tuple(0.0, 0.0),
          "Currents, A, array (coils,), that make the steered cells swim along `u`, field units, at a\n"
          "position, m, world frame: the polarity of the cells is taken into account.")
      .def(
          "image_from_world",
          [](const C& c, py::handle p) {
            return array_of(c.frame.image_from_world(vector_of(p, "position")));
          },
          py::arg("position"), "Image position, px (y down), of a position, m, world frame.")
      .def(
          "world_from_image",
          [](const C& c, py::handle p) {
            return array_of(c.frame.world_from_image(vector_of(p, "position")));
          },
          py::arg("position"), "Position, m, world frame, of an image position, px (y down).")
      .def("__repr__", [](const C& c) {
        return fmt::format("<faba.Context {} coils, frame period {:.4g} s, {:.4g} m per px>",
                           c.max_current.size(), c.frame_period, c.scale.m_per_px);
      });
}

}  // namespace

Command drift_command(const ControlContext& c, Vec2 at, const Drift& drift) {
  return field_command(c, at, (c.scale.iteration / c.scale.m_per_px) * drift.velocity);
}

void bind_loop_values(py::module_& m) {
  bind_observation(m);
  bind_estimate(m);
  bind_target(m);
  bind_tick(m);
  bind_context(m);
}

}  // namespace faba::python
