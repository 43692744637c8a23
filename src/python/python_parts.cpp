#include "python/python_parts.h"

#include <fmt/format.h>

#include "core/counted.h"
#include "python/convert.h"
#include "python/loop_values.h"
#include "python/python_object.h"

namespace faba::python {
namespace {

constexpr const char* kPython = "python";  // type of the parts of a run

struct PythonParams {
  std::string class_name;
};

Schema<PythonParams> python_schema(const std::string& type) {
  return Schema<PythonParams>(type, "A class in Python")
      .add("class", &PythonParams::class_name, {.doc = "The class, as \"module:Class\""});
}

class PythonController final : public Controller {
 public:
  PythonController(PartObject part, const ControlContext& c) : part_(std::move(part)), context_(c) {}

  Command update(const Estimate& e, const Target& target, double dt) override {
    Command command = part_.call([&](const py::object& instance) {
      return command_of(instance.attr("update")(e, target, dt), e.centroid);
    });
    // The contract of Trait::feedback, whatever the class returns.
    if (!(e.visible > 0) || !std::isfinite(norm(e.centroid)))
      std::fill(command.current.begin(), command.current.end(), 0.0);
    return command;
  }
  void archive(Archive& a) override { part_.archive(a); }

 private:
  Command command_of(const py::object& value, Vec2 centroid) const {
    const std::string where = part_.where() + ".update()";
    if (py::isinstance<Drift>(value)) {
      const Drift drift = value.cast<Drift>();
      if (!std::isfinite(norm(drift.velocity)))
        throw Error(Errc::usage, where, "the drift is not finite; give finite numbers, m/s");
      return drift_command(context_, centroid, drift);
    }
    if (value.is_none())
      throw Error(Errc::usage, where,
                  "returned None; return faba.Drift(x, y), m/s, or one current for each coil, A");
    Command c{numbers_of(value, where)};
    if (c.current.size() != context_.max_current.size())
      throw Error(
          Errc::usage, where,
          fmt::format("returned {}, but the field has {}; return one current for each coil, A",
                      counted(c.current.size(), "current"), counted(context_.max_current.size(), "coil")));
    return c;
  }

  PartObject part_;
  ControlContext context_;
};

class PythonEstimator final : public Estimator {
 public:
  explicit PythonEstimator(PartObject part) : part_(std::move(part)) {}

  Estimate update(const Observation& o, const Command& last) override {
    return part_.call([&](const py::object& instance) {
      const py::object value =
          instance.attr("update")(std::make_shared<Observation>(o), array_of(last.current));
      if (!py::isinstance<Estimate>(value))
        throw Error(Errc::usage, part_.where() + ".update()",
                    "did not return an estimate; return faba.Estimate(t, centroid, visible)");
      return value.cast<Estimate>();
    });
  }
  void archive(Archive& a) override { part_.archive(a); }

 private:
  PartObject part_;
};

class PythonReference final : public Reference {
 public:
  explicit PythonReference(PartObject part) : part_(std::move(part)) {
    part_.call([&](const py::object& instance) {
      for (const auto point : py::list(py::getattr(instance, "setpoints", py::list())))
        setpoints_.push_back(vector_of(point, part_.where() + ".setpoints"));
      const py::object tolerance = py::getattr(instance, "tolerance_px", py::none());
      if (!tolerance.is_none()) tolerance_px_ = tolerance.cast<double>();
    });
  }

  Target update(const Estimate& e) override {
    return part_.call([&](const py::object& instance) {
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      const py::object value = instance.attr("update")(e);
      if (value.is_none()) return Target{{kNone, kNone}};
      if (py::isinstance<Target>(value)) return value.cast<Target>();
      return Target{vector_of(value, part_.where() + ".update()")};
    });
  }
  std::vector<Vec2> setpoints() const override { return setpoints_; }
  std::optional<double> tolerance_px() const override { return tolerance_px_; }
  void archive(Archive& a) override { part_.archive(a); }

 private:
  PartObject part_;
  std::vector<Vec2> setpoints_;
  std::optional<double> tolerance_px_;
};

// The class "module:Class" of a scenario. The caller has the GIL.
py::object imported(const std::string& name, const std::string& where) {
  const auto colon = name.find(':');
  if (colon == std::string::npos)
    throw Error(Errc::usage, where, fmt::format("\"{}\" is not a class; write \"module:Class\"", name));
  try {
    py::object at = py::module_::import(name.substr(0, colon).c_str());
    for (const auto part : py::str(name.substr(colon + 1)).attr("split")(".")) at = at.attr(part);
    return at;
  } catch (const py::error_already_set& e) {
    throw Error(
        Errc::usage, where,
        fmt::format("the class {} cannot be imported ({}); start Python where its module is found, or "
                    "give the object as an argument",
                    name, py::str(e.value()).cast<std::string>()));
  }
}

// Adds a type: the object `given`, or the class that the scenario names.
template <class Registry, class Make>
void add_python(Registry& registry, const std::string& type, const std::vector<Trait>& its_traits,
                const py::object& given, const std::shared_ptr<Raised>& raised, Make make) {
  std::optional<SharedObject> object;
  if (!given.is_none()) object.emplace(given);
  registry.template add_made<PythonParams>(
      python_schema(type), its_traits,
      [=, where = registry.kind()](const PythonParams& p, const ControlContext& c) {
        const py::gil_scoped_acquire gil;
        const SharedObject part = object ? *object : SharedObject(imported(p.class_name, where));
        return make(PartObject(part, py::cast(c), where, raised), c);
      });
}

}  // namespace

void add_python_controller(Parts& p, const std::string& type, const py::object& given,
                           const std::shared_ptr<Raised>& raised) {
  add_python(p.controller, type, {Trait::feedback}, given, raised,
             [](PartObject part, const ControlContext& c) -> std::unique_ptr<Controller> {
               return std::make_unique<PythonController>(std::move(part), c);
             });
}

Parts GivenParts::parts(const std::shared_ptr<Raised>& raised) const {
  Parts p = builtin_parts();
  add_python(p.estimator, kPython, {}, estimator, raised,
             [](PartObject part, const ControlContext&) -> std::unique_ptr<Estimator> {
               return std::make_unique<PythonEstimator>(std::move(part));
             });
  add_python(p.reference, kPython, {}, reference, raised,
             [](PartObject part, const ControlContext&) -> std::unique_ptr<Reference> {
               return std::make_unique<PythonReference>(std::move(part));
             });
  add_python_controller(p, kPython, controller, raised);
  return p;
}

void GivenParts::name_in(Document& d) const {
  const auto name = [&](const char* key, const py::object& part) {
    if (part.is_none()) return;
    // A name or a table of a built-in part, as in a scenario.
    if (py::isinstance<py::str>(part) || py::isinstance<py::dict>(part))
      d.set(key, json_of(part, key), key);
    else
      d.set(key, Json{{"type", kPython}, {"class", class_name(part)}}, key);
  };
  name("estimator", estimator);
  name("reference", reference);
  name("controller", controller);
}

}  // namespace faba::python
