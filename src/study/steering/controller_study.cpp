#include "study/steering/controller_study.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "app/scenario/file_kind.h"

namespace faba {
namespace {

struct StudyFile {
  std::string title, scene;
  int seeds = 20;
  std::uint64_t first_seed = 1;
  std::vector<int> delays;
  static Schema<StudyFile> schema() {
    return Schema<StudyFile>("compare-controllers", "Comparison of controllers with models and delays")
        .add("title", &StudyFile::title, {.doc = "Title of the study in reports"})
        .add("scene", &StudyFile::scene,
             {.doc = "Scenario of all trials, relative to the folder of the study file"})
        .add("seeds", &StudyFile::seeds,
             {.min = 2, .max = 100000, .doc = "Number of trials of each combination, one seed each"})
        .add("first_seed", &StudyFile::first_seed, {.min = 0, .max = 9e15, .doc = "Seed of the first trial"})
        .add("delays", &StudyFile::delays,
             {.min = 0, .max = 1000, .doc = "Camera delays in frames; default: that of the scene"});
  }
};

}  // namespace

ControllerStudy read_controller_study(const std::filesystem::path& file) {
  const Document d = read_toml(file);
  const Node root(d);
  require_kind(root, FileKind::controller_study);
  const StudyFile f = StudyFile::schema().parse(root, {"controller", "model"});
  if (f.scene.empty())
    root.fail("key \"scene\" is missing; specify the scenario of all trials: scene = \"scene.toml\"");
  std::error_code ec;
  if (!std::filesystem::exists(root.file(f.scene), ec))
    throw Error(Errc::usage, root.where("scene"),
                fmt::format("file not found: {} (relative to the study file)", f.scene));
  ControllerStudy study;
  study.title = f.title.empty() ? file.stem().string() : f.title;
  study.scene = read_toml(root.file(f.scene));
  study.controllers = read_variants(root, "controller");
  study.models = read_variants(root, "model");
  if (root.has("delays") && f.delays.empty())
    root.child("delays").fail(
        "is an empty list; list camera delays in frames, such as [0, 2, 5], or omit the key for that of the "
        "scene");
  if (std::set<int>(f.delays.begin(), f.delays.end()).size() != f.delays.size())
    root.child("delays").fail("a delay is listed twice; delays must be unique");
  study.delays = f.delays;
  study.seeds = f.seeds;
  study.first_seed = f.first_seed;
  return study;
}

Json controller_study_schema() {
  Json j = StudyFile::schema().json_schema();
  j["properties"]["controller"] = {{"type", "array"},
                                   {"description", "The controllers, one [[controller]] each"},
                                   {"items", variant_schema("A controller")}};
  j["properties"]["model"] = {{"type", "array"},
                              {"description", "The models of the cells, one [[model]] each"},
                              {"items", variant_schema("A model of the cells")}};
  return j;
}

}  // namespace faba
