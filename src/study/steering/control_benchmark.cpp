#include "study/steering/control_benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/scenario/file_kind.h"
#include "core/hash.h"
#include "core/schema.h"
#include "core/statistics.h"
#include "study/steering/controller_trials.h"
#include "study/steering/metric_list.h"
#include "study/steering/trial.h"

namespace faba {
namespace {

struct KeepOutRegion {
  std::vector<Vec2> corners_px;
  static Schema<KeepOutRegion> schema() {
    return Schema<KeepOutRegion>("keep_out", "A region that the swarm must not enter")
        .add("corners_px", &KeepOutRegion::corners_px,
             {.unit = "px",
              .min = -1e5,
              .max = 1e5,
              .doc = "Corners of a polygon in image coordinates, y down"});
  }
};

struct CaseFile {
  std::string name, about, scene, literature;
  std::vector<std::string> controllers, baseline;
  std::vector<int> delays;
  std::string ranked_by = "steady_rms_px";
  std::optional<double> speed;
  std::vector<KeepOutRegion> keep_out;
  static Schema<CaseFile> schema() {
    return Schema<CaseFile>("case", "A case of the benchmark")
        .add("name", &CaseFile::name, {.doc = "Name in tables"})
        .add("about", &CaseFile::about, {.doc = "What the case tests, in one sentence"})
        .add("scene", &CaseFile::scene, {.doc = "Scenario, relative to the folder of the benchmark"})
        .add("controllers", &CaseFile::controllers,
             {.doc = "Names of the controllers of this case; default: all controllers of the benchmark"})
        .add("baseline", &CaseFile::baseline,
             {.doc = "Names of the controllers with the best of which all others are compared"})
        .add("delays", &CaseFile::delays,
             {.min = 0, .max = 1000, .doc = "Camera delays in frames; default: that of the scene"})
        .add("ranked_by", &CaseFile::ranked_by, {.doc = "Metric of the best controller"})
        .add("speed", &CaseFile::speed,
             {.unit = "m/s",
              .min = 1e-8,
              .max = 1,
              .doc = "Speed of the cells, for the ratio of the largest distance and the speed"})
        .add("literature", &CaseFile::literature,
             {.doc = "A published result with its source, and the differences of the set-ups"})
        .add("keep_out", &CaseFile::keep_out,
             {.doc = "Regions that the swarm must not enter: [[case.keep_out]] with corners_px"});
  }
};

struct BenchmarkFile {
  std::string title;
  int version = 1, seeds = 20;
  std::uint64_t first_seed = 1;
  static Schema<BenchmarkFile> schema() {
    return Schema<BenchmarkFile>("benchmark-control", "Benchmark of controllers")
        .add("title", &BenchmarkFile::title, {.doc = "Title in reports"})
        .add("version", &BenchmarkFile::version,
             {.min = 1, .max = 1e6, .doc = "Version of the set of cases; results of two versions differ"})
        .add("seeds", &BenchmarkFile::seeds, {.min = 2, .max = 100000, .doc = "Trials of each combination"})
        .add("first_seed", &BenchmarkFile::first_seed,
             {.min = 0, .max = 9e15, .doc = "Seed of the first trial"});
  }
};

void apply_set(const Node& n, Document& scene) {
  if (!n.has("set")) return;
  const Node set = n.child("set");
  if (!set.json->is_object()) set.fail("must be a table of paths and values");
  for (const auto& [path, to] : set.json->items()) scene.set(path, to, set.where());
}

std::vector<Variant> chosen(const std::vector<Variant>& all, const std::vector<std::string>& names,
                            const Node& n) {
  if (names.empty()) return all;
  std::vector<Variant> some;
  for (const std::string& name : names) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const Variant& v) { return v.name == name; });
    if (it == all.end()) {
      std::vector<std::string> known;
      known.reserve(all.size());
      for (const Variant& v : all) known.push_back(v.name);
      n.fail(fmt::format("controllers: \"{}\" is not a controller of the benchmark{}", name,
                         suggestion(name, known)));
    }
    some.push_back(*it);
  }
  return some;
}

void check_case(const BenchmarkCase& c, const Node& n) {
  for (const std::string& name : c.study.baseline)
    if (std::none_of(c.study.controllers.begin(), c.study.controllers.end(),
                     [&](const Variant& v) { return v.name == name; }))
      n.fail(fmt::format("baseline: \"{}\" is not a controller of this case", name));
  std::vector<std::string> metrics;
  for (const MetricInfo* m : compared_metrics()) metrics.emplace_back(m->key);
  if (std::find(metrics.begin(), metrics.end(), c.study.ranked_by) == metrics.end())
    n.fail(fmt::format("ranked_by: \"{}\" is not a metric that is compared{}", c.study.ranked_by,
                       suggestion(c.study.ranked_by, metrics)));
  for (const auto& polygon : c.study.keep_out_px)
    if (polygon.size() < 3) n.fail("keep_out: a polygon has at least 3 corners");
}

BenchmarkCase read_case(const Node& n, const Node& root, const BenchmarkFile& b,
                        const std::vector<Variant>& controllers) {
  const CaseFile f = CaseFile::schema().parse(n, {"set"});
  if (f.name.empty()) n.fail("key \"name\" is missing");
  if (f.scene.empty()) n.fail("key \"scene\" is missing; specify a scenario: scene = \"scene.toml\"");
  std::error_code ec;
  if (!std::filesystem::exists(root.file(f.scene), ec))
    throw Error(Errc::usage, n.where("scene"),
                fmt::format("file not found: {} (relative to the benchmark file)", f.scene));
  BenchmarkCase c{f.name, f.about, f.literature, f.speed, {}};
  ControllerStudy& s = c.study;
  s.title = f.name;
  s.label = f.name;
  s.scene = read_toml(root.file(f.scene));
  apply_set(n, s.scene);
  s.controllers = chosen(controllers, f.controllers, n);
  s.models = {{.name = "as the scene has it", .origin = n.where()}};
  if (n.has("controllers") && f.controllers.empty())
    n.fail("controllers is an empty list; name some, or omit the key for all controllers of the benchmark");
  if (std::set<int>(f.delays.begin(), f.delays.end()).size() != f.delays.size())
    n.fail("delays: a delay is listed twice; delays must be unique");
  s.delays = f.delays;
  s.seeds = b.seeds;
  s.first_seed = b.first_seed;
  s.ranked_by = f.ranked_by;
  s.baseline = f.baseline;
  for (const KeepOutRegion& region : f.keep_out) s.keep_out_px.push_back(region.corners_px);
  check_case(c, n);
  return c;
}

}  // namespace

ControlBenchmark read_control_benchmark(const std::filesystem::path& file,
                                        const std::vector<std::string>& only) {
  const Document d = read_toml(file);
  const Node root(d);
  require_kind(root, FileKind::control_benchmark);
  const BenchmarkFile f = BenchmarkFile::schema().parse(root, {"controller", "case"});
  ControlBenchmark b{f.title.empty() ? file.stem().string() : f.title, f.version, {}};
  const std::vector<Variant> controllers = read_variants(root, "controller");
  const Node cases = root.child("case");
  if (!cases.json->is_array() || cases.json->empty()) cases.fail("must be one or more tables [[case]]");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < cases.json->size(); ++i) {
    BenchmarkCase c = read_case(cases.item(i), root, f, controllers);
    if (std::find(names.begin(), names.end(), c.name) != names.end())
      cases.item(i).fail(fmt::format("the name \"{}\" is used twice; names must be unique", c.name));
    names.push_back(c.name);
    if (only.empty() || std::find(only.begin(), only.end(), c.name) != only.end())
      b.cases.push_back(std::move(c));
  }
  for (const std::string& name : only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(Errc::usage, "--only",
                  fmt::format("\"{}\" is not a case{}", name, suggestion(name, names)));
  return b;
}

Json control_benchmark_schema() {
  Json j = BenchmarkFile::schema().json_schema();
  j["properties"]["controller"] = {{"type", "array"},
                                   {"description", "The controllers, one [[controller]] each"},
                                   {"items", variant_schema("A controller")}};
  Json one = CaseFile::schema().json_schema();
  one["properties"]["set"] = {{"type", "object"},
                              {"description", "Values of the scenario to override, by path"}};
  j["properties"]["case"] = {
      {"type", "array"}, {"description", "The cases, one [[case]] each"}, {"items", one}};
  return j;
}

std::string study_hash(const ControlBenchmark& b) {
  Hash h;
  h.text("benchmark-control");
  h.value(b.version);
  for (const BenchmarkCase& c : b.cases) h.text(study_hash(c.study));
  return h.hex();
}

std::optional<ControlBenchmarkResult> run_control_benchmark(const ControlBenchmark& b, ResultStore& results,
                                                            const SweepOptions& options) {
  ControlBenchmarkResult r{b, {}};
  for (const BenchmarkCase& c : b.cases) {
    std::optional<ControllerComparison> one = compare_controllers(c.study, results, options);
    if (!one) return {};
    r.cases.push_back(std::move(*one));
  }
  return r;
}

Round control_benchmark_round(const ControlBenchmark& b, const std::string& description,
                              const std::function<bool()>& stop) {
  for (const BenchmarkCase& c : b.cases) {
    Round round = controller_trials(c.study, stop);
    if (round.description == description) return round;
  }
  throw Error(Errc::input, "round", "does not belong to this benchmark");
}

std::vector<CycleTime> measured_cycle_times(const ControlBenchmark& b, const std::function<bool()>& stop) {
  std::vector<CycleTime> all;
  for (const BenchmarkCase& c : b.cases) {
    const Settings settings = settings_of(c.study);
    for (const Setting& s : *settings) {
      if (stop()) throw study_stopped();
      std::vector<double> times = cycle_times(s.scenario, c.study.first_seed);
      std::sort(times.begin(), times.end());
      all.push_back({c.name, c.study.controllers[s.controller].name, s.delay, quantile(times, 0.5),
                     quantile(times, 0.999), times.back(), 1 / s.scenario.camera.rate});
    }
  }
  return all;
}

}  // namespace faba
