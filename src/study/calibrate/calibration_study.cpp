#include "study/calibrate/calibration_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "app/scenario/file_kind.h"
#include "core/error.h"
#include "core/hash.h"
#include "study/identify/families/model_family.h"

namespace faba {
namespace {

constexpr int kMostExperiments = 1000000;
constexpr const char* kWellSpecified = "well-specified";

struct CalibrationFile {
  std::string title, study;
  std::uint64_t seed = 1;
  int experiments = 100;
  std::optional<Look> look;
  std::vector<std::string> models, true_models;
  static Schema<CalibrationFile> schema() {
    return Schema<CalibrationFile>("calibrate", "Calibration of a study for identification")
        .add("title", &CalibrationFile::title, {.doc = "Title of the calibration in reports"})
        .add("study", &CalibrationFile::study,
             {.doc = "Study for `faba identify`, relative to the folder of this file; its videos give frame "
                     "size, frame rate, field segments and initial positions"})
        .add("seed", &CalibrationFile::seed, {.min = 0, .max = 9e15, .doc = "Seed of all random numbers"})
        .add("experiments", &CalibrationFile::experiments,
             {.min = 0,
              .max = kMostExperiments,
              .doc = "Number of experiments in which the cells are as the true model describes"})
        .add("look", &CalibrationFile::look,
             {.doc = "How the experiments are observed: rendered to a video and measured like one, or as "
                     "positions of the cells, which is faster; default: as in the study",
              .choices = {"video", "positions"}})
        .add("models", &CalibrationFile::models,
             {.doc = "Names of the candidates of the study that are identified; default: all"})
        .add("true_models", &CalibrationFile::true_models,
             {.doc = "Names of the candidates from which experiments are sampled, in turn; default: all that "
                     "are identified"});
  }
};

struct MisspecifiedFile {
  std::string name;
  std::optional<int> experiments;
  std::vector<std::string> true_models, aspects;
  double second_swarm = 0, field_factor = 1;
  std::optional<double> timing;
  static Schema<MisspecifiedFile> schema() {
    return Schema<MisspecifiedFile>("misspecified", "Experiments that differ from what the study states")
        .add("name", &MisspecifiedFile::name, {.doc = "What differs, for reports"})
        .add("experiments", &MisspecifiedFile::experiments,
             {.min = 1, .max = kMostExperiments, .doc = "Number of experiments; default: as at the top"})
        .add("true_models", &MisspecifiedFile::true_models, {.doc = "As at the top, which is the default"})
        .add("second_swarm", &MisspecifiedFile::second_swarm,
             {.min = 0, .max = 0.9, .doc = "Fraction of the cells that become swarm[1], a copy of swarm[0]"})
        .add("field_factor", &MisspecifiedFile::field_factor,
             {.min = 1e-3, .max = 100, .doc = "True field strength over the field strength of the study"})
        .add("timing", &MisspecifiedFile::timing,
             {.unit = "s",
              .min = 0,
              .max = 10,
              .doc = "True standard deviation of the times of field reversals; default: as in the study"})
        .add("aspects", &MisspecifiedFile::aspects,
             {.doc = "Aspects of warnings of `faba identify` that name the difference, such as turning"});
  }
};

std::vector<std::size_t> named(const std::vector<std::string>& names, const IdentifyStudy& study,
                               const Node& n, const char* key) {
  std::vector<std::size_t> found;
  std::vector<std::string> all;
  for (const Candidate& c : study.candidates) all.push_back(c.model.name);
  for (const std::string& name : names) {
    const auto at = std::find(all.begin(), all.end(), name);
    if (at == all.end())
      n.child(key).fail(
          fmt::format("unknown model \"{}\"; the study identifies: {}", name, fmt::join(all, ", ")));
    found.push_back(std::size_t(at - all.begin()));
  }
  if (names.empty()) {
    found.resize(all.size());
    std::iota(found.begin(), found.end(), std::size_t(0));
  }
  return found;
}

void check_aspects(const std::vector<std::string>& aspects, const Node& n) {
  for (const std::string& aspect : aspects)
    if (std::find(kFamilyAspects.begin(), kFamilyAspects.end(), aspect) == kFamilyAspects.end())
      n.child("aspects").fail(fmt::format("unknown aspect \"{}\"; it must be one of {}", aspect,
                                          fmt::join(kFamilyAspects, ", ")));
}

ExperimentKind misspecified_kind(const Node& n, const CalibrationStudy& study, const CalibrationFile& top) {
  const MisspecifiedFile f = MisspecifiedFile::schema().parse(n, {"set"});
  if (f.name.empty()) n.fail("key \"name\" is missing; name the difference: name = \"the cells tumble\"");
  check_aspects(f.aspects, n);
  ExperimentKind k{.name = f.name,
                   .experiments = f.experiments.value_or(top.experiments),
                   .true_models = f.true_models.empty()
                                      ? study.kinds.front().true_models
                                      : named(f.true_models, study.design, n, "true_models"),
                   .second_swarm = f.second_swarm,
                   .field_factor = f.field_factor,
                   .timing_s = f.timing,
                   .aspects = f.aspects,
                   .misspecified = true,
                   .where = n.where("set")};
  if (n.has("set")) {
    if (!n.child("set").json->is_object()) n.child("set").fail("must be a table of paths and values");
    for (const auto& [path, value] : n.child("set").json->items()) k.set.emplace_back(path, value);
  }
  if (k.set.empty() && k.second_swarm == 0 && k.field_factor == 1 && !k.timing_s)
    n.fail(
        "nothing differs; give set = { \"swarm[0].model.tumble_rate\" = \"2 1/s\" }, second_swarm, "
        "field_factor or timing");
  return k;
}

void read_kinds(const Node& root, const CalibrationFile& f, CalibrationStudy& study) {
  study.kinds.push_back({.name = kWellSpecified,
                         .experiments = f.experiments,
                         .true_models = named(f.true_models, study.design, root, "true_models")});
  if (!root.has("misspecified")) return;
  const Node list = root.child("misspecified");
  if (!list.json->is_array()) list.fail("must be one or more tables [[misspecified]]");
  std::set<std::string> names{kWellSpecified};
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    study.kinds.push_back(misspecified_kind(list.item(i), study, f));
    if (!names.insert(study.kinds.back().name).second)
      list.item(i).fail(
          fmt::format("the name \"{}\" is used twice; names must be unique", study.kinds.back().name));
  }
}

// The study with the candidates and the look of the calibration.
IdentifyStudy design_of(const std::filesystem::path& file, const CalibrationFile& f, const Node& root,
                        bool needs_videos) {
  IdentifyStudy study = read_identify_study(file, needs_videos);
  study.legacy = false;
  study.look = f.look.value_or(study.look);
  if (f.models.empty()) return study;
  std::vector<Candidate> selected;
  for (const std::size_t i : named(f.models, study, root, "models")) selected.push_back(study.candidates[i]);
  study.candidates = std::move(selected);
  return study;
}

}  // namespace

CalibrationStudy read_calibration_study(const std::filesystem::path& file, bool needs_videos) {
  const Document d = read_toml(file);
  const Node root(d);
  CalibrationStudy study;
  CalibrationFile f;
  std::filesystem::path design = file;
  const std::optional<FileKind> kind = file_kind(root);
  // Without candidates the study is incomplete; its reader asks for them.
  const bool is_design = kind == FileKind::identify_study || kind == FileKind::activity_study;
  if (!is_design) {
    require_kind(root, FileKind::calibration_study);
    f = CalibrationFile::schema().parse(root, {"misspecified"});
    if (f.study.empty())
      root.fail("key \"study\" is missing; specify a study for `faba identify`: study = \"study.toml\"");
    design = root.file(f.study);
    std::error_code ec;
    if (!std::filesystem::exists(design, ec))
      throw Error(Errc::usage, root.where("study"),
                  fmt::format("file not found: {} (relative to the calibration file)", f.study));
  }
  study.design = design_of(design, f, root, needs_videos);
  study.designed_by = design.filename().string();
  study.seed = f.seed;
  study.title = f.title.empty() ? fmt::format("Calibration of {}", design.stem().string()) : f.title;
  if (is_design)
    read_kinds(Node(Document{}), f, study);
  else
    read_kinds(root, f, study);
  if (study.experiments() == 0) root.fail("experiments is 0 and there is no [[misspecified]]");
  if (study.design.look == Look::video && study.design.boundary == Boundary::none)
    root.fail("experiments without a boundary cannot be rendered; give look = \"positions\"");
  return study;
}

Json calibration_study_schema() {
  Json j = CalibrationFile::schema().json_schema();
  Json item = MisspecifiedFile::schema().json_schema();
  item["properties"]["set"] = {
      {"type", "object"}, {"description", "Values of the true scenario, by path; they replace sampled ones"}};
  j["properties"]["misspecified"] = {
      {"type", "array"}, {"description", "Experiments that no candidate describes"}, {"items", item}};
  return j;
}

std::uint64_t CalibrationStudy::experiments() const {
  std::uint64_t sum = 0;
  for (const ExperimentKind& k : kinds) sum += std::uint64_t(k.experiments);
  return sum;
}

std::pair<std::size_t, std::uint64_t> CalibrationStudy::kind_of(std::uint64_t experiment) const {
  std::size_t k = 0;
  while (experiment >= std::uint64_t(kinds.at(k).experiments))
    experiment -= std::uint64_t(kinds[k++].experiments);
  return {k, experiment};
}

std::string study_hash(const CalibrationStudy& study) {
  Hash h;
  h.text("calibrate");
  h.value(study.seed);
  h.text(study_hash(study.design));
  for (const ExperimentKind& k : study.kinds) {
    h.text(k.name);
    h.value(k.experiments);
    for (const std::size_t m : k.true_models) h.value(m);
    h.value(k.second_swarm);
    h.value(k.field_factor);
    if (k.timing_s) h.value(*k.timing_s);
    for (const auto& [path, value] : k.set) {
      h.text(path);
      h.text(value.dump());
    }
    for (const std::string& aspect : k.aspects) h.text(aspect);
  }
  return h.hex();
}

}  // namespace faba
