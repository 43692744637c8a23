#include "python/measures.h"

#include <fmt/format.h>

#include "app/scenario/rig_file.h"
#include "app/scenario/scenario_schema.h"
#include "core/counted.h"
#include "core/process/installation.h"
#include "field/allocate.h"
#include "field/null.h"
#include "python/convert.h"
#include "python/raised.h"
#include "study/data/flow_choice.h"
#include "vision/image/kernels/histogram_distance.h"

namespace faba::python {
namespace {

/// The magnetic field of a coil system.
struct CoilField {
  std::shared_ptr<const Field> field;

  // One current for each coil; None: the currents of the file.
  std::vector<double> currents(const py::object& given) const {
    if (given.is_none()) return field->default_currents();
    std::vector<double> c = numbers_of(given, "currents");
    if (c.size() != field->coils())
      throw Error(Errc::usage, "currents",
                  fmt::format("has {}, but the field has {}; give one current for each coil, A",
                              counted(c.size(), "current"), counted(field->coils(), "coil")));
    return c;
  }
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Numbers (..., 2) or (..., 3).
Numbers positions_of(const py::object& at) {
  Numbers a = Numbers::ensure(at);
  if (!a) PyErr_Clear();
  const auto last = a && a.ndim() ? a.shape(a.ndim() - 1) : 0;
  if (last != 2 && last != 3)
    throw Error(Errc::usage, "at",
                "must be an array of positions x, y or x, y, z: shape (..., 2) or (..., 3), m");
  return a;
}

// Points, m; z = 0 where it is missing.
std::vector<Vec3> points_of(const Numbers& at) {
  const auto last = at.shape(at.ndim() - 1);
  std::vector<Vec3> points(std::size_t(at.size() / last));
  const double* from = at.data();
  for (Vec3& p : points) {
    p = {from[0], from[1], last == 3 ? from[2] : 0.0};
    from += last;
  }
  return points;
}

py::array_t<double> field_at(const CoilField& f, const py::object& positions, const py::object& given) {
  const Numbers at = positions_of(positions);
  const std::vector<Vec3> points = points_of(at);
  const std::vector<double> current = f.currents(given);
  std::vector<Vec3> b(points.size());
  Raised().run([&] { f.field->at(points, current, b); });
  std::vector<py::ssize_t> shape(at.shape(), at.shape() + at.ndim() - 1);
  shape.push_back(3);
  py::array_t<double> result(shape);
  double* to = result.mutable_data();
  for (const Vec3& v : b)
    for (const double c : {v.x, v.y, v.z}) *to++ = c;
  return result;
}

py::dict field_null(const CoilField& f, const py::object& at, int polarity) {
  if (polarity != 1 && polarity != -1)
    throw Error(Errc::usage, "polarity", fmt::format("is {}; give 1 for north-seeking or -1", polarity));
  const FieldNull n = null_at(*f.field, vector_of(at, "at"), polarity, current_limits(*f.field));
  py::dict d;
  d["currents"] = array_of(n.current);
  d["gradient"] = array_of(std::vector<double>(n.gradient.begin(), n.gradient.end()));
  d["reachable"] = n.reachable;
  d["saddle"] = n.saddle;
  return d;
}

CoilField make_field(const py::object& rig) {
  if (py::isinstance<py::dict>(rig)) {
    Document d;
    d.name = "rig";
    d.root = json_of(rig, "");
    return {read_rig(std::move(d), builtin_parts()).make({})};
  }
  if (!py::isinstance<py::str>(rig) && !py::hasattr(rig, "__fspath__"))
    throw Error(
        Errc::usage, "rig",
        fmt::format("has the type {}; give the path of a coil system file, or its content as a dictionary",
                    py::str(py::type::of(rig).attr("__name__")).cast<std::string>()));
  return {read_rig(py::str(rig).cast<std::string>(), builtin_parts()).make({})};
}

void bind_field(py::module_& m) {
  py::class_<CoilField>(
      m, "Field",
      "The magnetic field of a coil system.\n\nrig : path of a coil system file, or a dict of its "
      "content")
      .def(py::init(&make_field), py::arg("rig"))
      .def_property_readonly(
          "coils", [](const CoilField& f) { return f.field->coils(); }, "int: number of coils")
      .def_property_readonly(
          "currents", [](const CoilField& f) { return array_of(f.field->default_currents()); },
          "float array (coils,): default currents, A")
      .def_property_readonly(
          "max_currents", [](const CoilField& f) { return array_of(current_limits(*f.field)); },
          "float array (coils,): largest currents, A; 1 A for a coil without a limit")
      .def("at", field_at, py::arg("at"), py::arg("currents") = py::none(),
           "The field, T, array (..., 3), at positions, m, array (..., 2) or (..., 3), world frame;\n"
           "with the ambient field. currents : A, one for each coil; default: those of the file.")
      .def(
          "currents_for",
          [](const CoilField& f, const py::object& field, const py::object& at) {
            const Vec2 p = vector_of(at, "at");
            return array_of(allocate(*f.field, {p.x, p.y, 0}, vector_of(field, "field")));
          },
          py::arg("field"), py::arg("at") = py::make_tuple(0.0, 0.0),
          "Currents, A, array (coils,), for an in-plane field of the coils, T, at a position, m: those with "
          "the\n"
          "least sum of squares. They can be larger than max_currents.")
      .def("null", field_null, py::arg("at"), py::arg("polarity") = -1,
           "Currents for a zero of the field at a position, m, that traps cells of a polarity.\n\n"
           "Returns a dict: currents (A), gradient (eigenvalues, T/m), reachable (within the largest "
           "currents), "
           "saddle\n(traps in one direction only).")
      .def("__repr__", [](const CoilField& f) {
        return fmt::format("<faba.Field of {}>", counted(f.field->coils(), "coil"));
      });
}

GrayF image_of(const Numbers& a, const char* name) {
  if (a.ndim() != 2 || a.size() == 0)
    throw Error(Errc::usage, name, "is not a grey picture; give an array of the shape (height, width)");
  constexpr py::ssize_t kMost = 1 << 15;  // px, longest side
  if (a.shape(0) > kMost || a.shape(1) > kMost)
    throw Error(Errc::usage, name, fmt::format("has more than {} px on a side", kMost));
  GrayF image(int(a.shape(1)), int(a.shape(0)));
  for (std::size_t i = 0; i < image.px.size(); ++i) {
    if (!std::isfinite(a.data()[i])) throw Error(Errc::usage, name, "has a value that is not finite");
    image.px[i] = float(a.data()[i]);
  }
  return image;
}

py::array_t<float> flow(const Numbers& a, const Numbers& b, const std::string& method,
                        const py::dict& options, unsigned threads) {
  const GrayF first = image_of(a, "a"), second = image_of(b, "b");
  if (first.width != second.width || first.height != second.height)
    throw Error(Errc::usage, "b", "has another size than a; give two pictures of the same size");
  FlowChoice choice;
  choice.method = method;
  for (const auto& [key, value] : options)
    choice.values.emplace_back(py::str(key).cast<std::string>(), py::str(value).cast<std::string>());
  const FlowRegistry::PartType part = flow_part(choice);
  Flow result;
  Raised().run([&] {
    Pool pool(checked_threads(threads));
    part.make({&pool})->between(first, second, result);
  });
  py::array_t<float> out({first.height, first.width, 2});
  float* to = out.mutable_data();
  for (std::size_t i = 0; i < result.u.px.size(); ++i) {
    *to++ = result.u.px[i];
    *to++ = result.v.px[i];
  }
  return out;
}

double distance(const py::object& p, const py::object& q, double m, double threshold) {
  const std::vector<double> a = numbers_of(p, "p"), b = numbers_of(q, "q");
  if (a.size() != b.size())
    throw Error(Errc::usage, "q", fmt::format("has {}, but p has {}", counted(b.size(), "bin"), a.size()));
  return HistogramDistance(BinSimilarity::truncated_linear(threshold), m)(a, b);
}

py::object parts(const py::object& kind) {
  py::dict all;
  each_kind(builtin_parts(), [&](const char* key, const auto& registry) {
    py::dict of_kind;
    for (const auto& name : registry.names()) of_kind[py::str(name)] = object_of(registry.json_schema(name));
    all[py::str(key)] = of_kind;
  });
  if (kind.is_none()) return all;
  if (!all.contains(kind))
    throw Error(Errc::usage, "kind",
                fmt::format("unknown kind \"{}\"; known kinds: {}", py::str(kind).cast<std::string>(),
                            py::str(", ").attr("join")(all).cast<std::string>()));
  return all[kind];
}

}  // namespace

void bind_measures(py::module_& m) {
  bind_field(m);
  m.def("flow", flow, py::arg("a"), py::arg("b"), py::kw_only(), py::arg("method") = "horn_schunck",
        py::arg("options") = py::dict(), py::arg("threads") = 0,
        "Optical flow from picture a to picture b, px per pair: float32 array (height, width, 2), to the "
        "right\n"
        "and down.\n\na, b : arrays (height, width), grey values 0 to 255\n"
        "method : horn_schunck, dis or farneback\noptions : dict of its parameters (faba.parts(\"flow\"))\n"
        "threads : int, 0: all; does not change the result");
  m.def("distance", distance, py::arg("p"), py::arg("q"), py::kw_only(), py::arg("m") = 0.9,
        py::arg("threshold") = 3.0,
        "Quadratic-Chi distance of two histograms, a float, 0 if they are equal (Pele and Werman 2010).\n\n"
        "p, q : sequences of equal length, not negative\n"
        "m : exponent of the normalisation, from 0, less than 1\n"
        "threshold : distance of bins at which their similarity is zero");
  m.def("parts", parts, py::arg("kind") = py::none(),
        "JSON Schema of every part that a scenario can name, with meaning, unit, range, default and source "
        "of its\n"
        "parameters: a dict by kind and name, or by name for one kind such as \"controller\".");
  m.def(
      "schema", [] { return object_of(scenario_json_schema(builtin_parts())); },
      "JSON Schema of a scenario file, a dict: for editors and forms.");
  m.def(
      "set_program_folder", [](const std::string& folder) { set_program_folder(folder); }, py::arg("folder"),
      "Folder of the programs faba and faba-coil-guard, for the bench.");
}

}  // namespace faba::python
