#include "python/batch.h"

#include <fmt/format.h>

#include "control/setpoint_count.h"
#include "core/counted.h"
#include "core/file.h"
#include "python/convert.h"
#include "python/reported_progress.h"
#include "python/simulation.h"
#include "study/pages/steering/controller_report.h"
#include "study/steering/controller_study.h"
#include "study/steering/metric_list.h"
#include "study/steering/trial.h"

namespace faba::python {
namespace {

/// Names of metrics, or a function in Python on the finished simulation.
struct Statistic {
  std::vector<const MetricInfo*> metrics;
  std::optional<SharedObject> function;
};

const MetricInfo& metric_named(const std::string& name) {
  std::vector<std::string> known;
  for (const MetricInfo& m : metric_list()) {
    if (m.key == name) return m;
    known.emplace_back(m.key);
  }
  throw Error(Errc::usage, "statistic",
              fmt::format("unknown metric \"{}\"{}", name, suggestion(name, known)));
}

Statistic read_statistic(const py::object& value) {
  Statistic s;
  if (py::isinstance<py::str>(value)) {
    s.metrics.push_back(&metric_named(value.cast<std::string>()));
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    for (const auto name : value) s.metrics.push_back(&metric_named(py::str(name)));
  } else if (PyCallable_Check(value.ptr())) {
    s.function.emplace(value);
  }
  if (s.metrics.empty() && !s.function)
    throw Error(Errc::usage, "statistic",
                "is not the name of a metric, a list of names, or a function of the finished simulation");
  return s;
}

/// The values of the parameters of one set.
using ParameterSet = std::vector<std::pair<std::string, Json>>;

// One set for each element of the sequences; a single value belongs to all sets.
std::vector<ParameterSet> read_parameters(const py::dict& parameters) {
  std::size_t sets = 1;
  std::string longest;
  std::vector<std::pair<std::string, Json>> all;
  for (const auto& [path, value] : parameters) {
    const auto name = py::str(path).cast<std::string>();
    Json j = json_of(value, name);
    if (j.is_array()) {
      if (!longest.empty() && j.size() != sets)
        throw Error(Errc::usage, name,
                    fmt::format("has {}, but {} has {}; give sequences of equal length",
                                counted(j.size(), "value"), longest, sets));
      longest = name;
      sets = j.size();
    }
    all.emplace_back(name, std::move(j));
  }
  std::vector<ParameterSet> result(sets);
  for (std::size_t i = 0; i < sets; ++i)
    for (const auto& [name, values] : all)
      result[i].emplace_back(name, values.is_array() ? values[i] : values);
  return result;
}

std::vector<std::uint64_t> read_seeds(const py::object& seeds) {
  const Json j = json_of(seeds, "seeds");
  std::vector<std::uint64_t> result;
  for (const Json& one : j.is_array() ? j : Json::array({j})) {
    if (!one.is_number_integer() || one < 0)
      throw Error(Errc::usage, "seeds", "must be an integer from 0, or a sequence of them");
    result.push_back(one.get<std::uint64_t>());
  }
  return result;
}

/// The simulations of a call of simulate(), one for each set and seed.
class Batch {
 public:
  Batch(Document scene, std::vector<ParameterSet> sets, std::vector<std::uint64_t> seeds, Statistic statistic,
        Parts parts, std::shared_ptr<Raised> raised)
      : scene_(std::move(scene)),
        sets_(std::move(sets)),
        seeds_(std::move(seeds)),
        statistic_(std::move(statistic)),
        parts_(std::move(parts)),
        raised_(std::move(raised)),
        results_(sets_.size() * seeds_.size()) {}

  void run(unsigned threads, ReportedProgress& progress) {
    Pool pool(threads);
    std::atomic<std::uint64_t> done{0};
    pool.run_uneven(results_.size(), [&](std::size_t task) {
      if (raised_->stopped()) return;
      results_[task] = result(sets_[task / seeds_.size()], seeds_[task % seeds_.size()]);
      progress.report(++done, results_.size());
    });
  }

  /// The values by set and seed; a further axis for several metrics. Of a function: what it returned.
  py::object values() {
    if (statistic_.function) return returned();
    const std::size_t n = statistic_.metrics.size();
    std::vector<py::ssize_t> shape{py::ssize_t(sets_.size()), py::ssize_t(seeds_.size())};
    if (n > 1) shape.push_back(py::ssize_t(n));
    py::array_t<double> a(shape);
    double* to = a.mutable_data();
    for (const Result& r : results_)
      for (const double v : r.metrics) *to++ = v;
    return a;
  }

 private:
  struct Result {
    std::vector<double> metrics;
    std::optional<SharedObject> returned;
  };

  Result result(const ParameterSet& set, std::uint64_t seed) {
    Document d = scene_;
    for (const auto& [path, value] : set) set_value(d, path, value, "parameters");
    d.set("seed", Json(seed), "seeds");
    Scenario s = read_scenario_with(std::move(d), parts_);
    if (statistic_.function) return {{}, of_function(std::move(s))};
    const Series series = trial(s, seed, [&] { return raised_->stopped(); });
    const Metrics m = control_metrics(series);
    std::vector<double> values;
    for (const MetricInfo* one : statistic_.metrics)
      values.push_back((m.*one->value).value_or(std::numeric_limits<double>::quiet_NaN()));
    return {std::move(values), {}};
  }

  SharedObject of_function(Scenario s) {
    const auto simulation = std::make_shared<PySimulation>(std::move(s), 1, raised_);
    simulation->run({});
    const py::gil_scoped_acquire gil;
    try {
      return SharedObject(statistic_.function->get()(simulation));
    } catch (const py::error_already_set& e) {
      throw raised_->keep("statistic", e);
    }
  }

  py::object returned() {
    py::list rows;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      py::list row;
      for (std::size_t k = 0; k < seeds_.size(); ++k)
        row.append(results_[i * seeds_.size() + k].returned->get());
      rows.append(row);
    }
    return py::module_::import("numpy").attr("array")(rows);
  }

  Document scene_;
  std::vector<ParameterSet> sets_;
  std::vector<std::uint64_t> seeds_;
  Statistic statistic_;
  Parts parts_;
  std::shared_ptr<Raised> raised_;
  std::vector<Result> results_;
};

void require_class(const py::object& part, const char* key) {
  if (part.is_none() || py::isinstance<py::type>(part) || py::isinstance<py::str>(part) ||
      py::isinstance<py::dict>(part))
    return;
  throw Error(
      Errc::usage, key,
      fmt::format("is an object of the class {}; give the class itself, because every simulation needs "
                  "its own object",
                  class_name(part)));
}

py::object simulate(const py::object& scene, const py::dict& parameters, const py::object& seeds,
                    const py::object& statistic, const py::object& duration, const py::object& set,
                    const py::object& controller, const py::object& estimator, const py::object& reference,
                    unsigned threads, const py::object& progress) {
  require_class(controller, "controller");
  require_class(estimator, "estimator");
  require_class(reference, "reference");
  const auto raised = std::make_shared<Raised>();
  const SceneArguments a{scene, py::none(), set, duration, {estimator, reference, controller}};
  Batch batch(read_document(a), read_parameters(parameters), read_seeds(seeds), read_statistic(statistic),
              a.parts.parts(raised), raised);
  ReportedProgress reported(progress, raised);
  raised->run([&] { batch.run(checked_threads(threads), reported); });
  return batch.values();
}

py::object compare(const py::object& path, const py::dict& controllers, const py::object& seeds,
                   unsigned threads, const py::object& page, const py::object& progress) {
  const auto raised = std::make_shared<Raised>();
  const auto file = py::str(path).cast<std::string>();
  ControllerStudy study = read_controller_study(file);
  if (!seeds.is_none()) study.seeds = seeds.cast<int>();
  // Each class is a part of its own name in the scenarios of the study.
  auto parts = std::make_shared<Parts>(builtin_parts());
  for (const auto& [name, part] : controllers) {
    const auto key = py::str(name).cast<std::string>();
    const auto object = py::reinterpret_borrow<py::object>(part);
    require_class(object, key.c_str());
    const bool table = py::isinstance<py::str>(object) || py::isinstance<py::dict>(object);
    Json as_table =
        table ? json_of(object, key) : Json{{"type", "python:" + key}, {"class", class_name(object)}};
    if (as_table.is_string()) as_table = Json{{"type", as_table}};
    if (!table) add_python_controller(*parts, "python:" + key, object, raised);
    study.controllers.push_back({.name = key, .part = as_table, .origin = "controllers." + key});
  }
  study.parts = parts;
  ResultStore results({}, study_hash(study));
  std::optional<ControllerComparison> comparison;
  SweepOptions options;
  options.threads = checked_threads(threads);
  ReportedProgress reported(progress, raised);
  options.progress = [&](std::uint64_t done, std::uint64_t total) { reported.report(done, total); };
  options.stop = [&] { return raised->stopped(); };
  raised->run([&] { comparison = compare_controllers(study, results, options); });
  if (!page.is_none()) {
    Provenance provenance;
    provenance.add(file);
    write_file(py::str(page).cast<std::string>(), controllers_page(*comparison, provenance));
  }
  return object_of(controllers_json(*comparison));
}

}  // namespace

void bind_batch(py::module_& m) {
  const auto none = py::none();
  m.def("simulate", simulate, py::arg("scene"), py::arg("parameters"), py::arg("seeds"), py::arg("statistic"),
        py::kw_only(), py::arg("duration") = none, py::arg("set") = none, py::arg("controller") = none,
        py::arg("estimator") = none, py::arg("reference") = none, py::arg("threads") = 0,
        py::arg("progress") = none, "Values of simulations of a scenario by parameter set and seed.");
  m.def("compare_controllers", compare, py::arg("study"), py::arg("controllers") = py::dict(), py::kw_only(),
        py::arg("seeds") = none, py::arg("threads") = 0, py::arg("page") = none, py::arg("progress") = none,
        "Result of a comparison of controllers, a dict.");
}

}  // namespace faba::python
