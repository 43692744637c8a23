#include "study/motion/activity_study.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "app/scenario/file_kind.h"
#include "app/scenario/parts.h"
#include "core/error.h"
#include "core/toml.h"
#include "study/experiment/experiment.h"
#include "vision/files/picture_sequence.h"

namespace faba {
namespace {

struct ActivityVideoFile {
  std::string file, experiment;
  std::optional<double> exposure, direction, reversal, from, to;
  static Schema<ActivityVideoFile> schema() {
    return Schema<ActivityVideoFile>("video", "One video of the study")
        .add("file", &ActivityVideoFile::file,
             {.doc = "Video, run directory or file of flows, relative to the folder of the study file"})
        .add("exposure", &ActivityVideoFile::exposure,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Air exposure time of the sample before the video"})
        .add("experiment", &ActivityVideoFile::experiment,
             {.doc = "Name of the experiment (drop) to which the video belongs"})
        .add("direction", &ActivityVideoFile::direction,
             {.unit = "deg",
              .min = -360,
              .max = 360,
              .doc = "Direction of the expected response: 0 right, 90 down in the image"})
        .add("reversal", &ActivityVideoFile::reversal,
             {.unit = "s",
              .min = 0,
              .max = 1e9,
              .doc = "Time of the field reversal in the video; default: as recorded by the run"})
        .add("from", &ActivityVideoFile::from,
             {.unit = "s",
              .min = 0,
              .max = 1e9,
              .doc = "Start time of the evaluation, and zero of the time of the response"})
        .add("to", &ActivityVideoFile::to,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "End time of the evaluation"})
        .check([](const ActivityVideoFile& v) -> std::string {
          return v.file.empty() ? "key \"file\" is missing; specify a video: file = \"video.avi\"" : "";
        });
  }
};

struct ActivityFile {
  std::optional<double> direction, threshold, reversal, from, to;
  std::string noise;
  static Schema<ActivityFile> schema() {
    return Schema<ActivityFile>("study", "Videos of samples after different air exposure times")
        .add("direction", &ActivityFile::direction,
             {.unit = "deg", .min = -360, .max = 360, .doc = "Default direction for videos without one"})
        .add("reversal", &ActivityFile::reversal,
             {.unit = "s",
              .min = 0,
              .max = 1e9,
              .doc = "Default time of the field reversal for videos without one"})
        .add("from", &ActivityFile::from,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "Default start time for videos without one"})
        .add("to", &ActivityFile::to,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "Default end time for videos without one"})
        .add("threshold", &ActivityFile::threshold,
             {.unit = "px",
              .min = 0,
              .max = 1e3,
              .doc = "Flow threshold, px per pair; smaller flows are noise"})
        .add("noise", &ActivityFile::noise,
             {.doc = "Video of a dead sample, from which the threshold is determined"})
        .check([](const ActivityFile& s) -> std::string {
          return s.threshold && !s.noise.empty() ? "specify either threshold or noise, not both" : "";
        });
  }
};

std::filesystem::path existing_file(const Node& n, const std::string& key, const std::string& name) {
  std::error_code ec;
  auto file = n.file(name);
  if (std::filesystem::exists(file, ec) || is_picture_sequence(file)) return file;
  throw Error(Errc::input, n.where(key),
              fmt::format("file not found: {} (relative to the study file)", name));
}

void take_experiment(const Document& d, ActivityJob& job) {
  const Node root(d);
  const Experiment e = read_experiment(d);
  job.group = "drop";
  if (e.videos.empty()) root.fail("[[video]] is missing; give one for each video");
  if (!e.noise.empty()) job.noise = existing_file(root, "noise", e.noise);
  for (std::size_t i = 0; i < e.videos.size(); ++i) {
    const ExperimentVideo& v = e.videos[i];
    job.videos.push_back({.file = existing_file(root.child("video").item(i), "file", v.file),
                          .exposure_s = v.exposure_s,
                          .experiment = v.drop,
                          .direction_deg = swimming_direction_deg(e, v),
                          .reversal_s = v.reversal_s,
                          .from_s = v.from_s.value_or(0),
                          .to_s = v.to_s,
                          .scale = scale_of(e, v)});
  }
}

}  // namespace

Json activity_study_schema() {
  Json j = ActivityFile::schema().json_schema();
  j["properties"]["video"] = {{"type", "array"},
                              {"description", "The videos, one [[video]] each"},
                              {"items", ActivityVideoFile::schema().json_schema()}};
  return j;
}

void read_activity_study(const std::filesystem::path& file, ActivityJob& job) {
  const Document d = read_toml(file);
  if (experiment_file(file)) return take_experiment(d, job);
  const Node root(d);
  require_kind(root, FileKind::activity_study);
  const ActivityFile study = ActivityFile::schema().parse(root, {"video", "flow"});
  if (root.has("flow")) job.method = builtin_flow_methods().resolve(root.child("flow"));
  if (study.threshold) job.threshold_px = study.threshold;
  if (!study.noise.empty()) job.noise = existing_file(root, "noise", study.noise);
  if (root.has("video") && !root.child("video").json->is_array())
    root.child("video").fail("must be an array of tables; write [[video]] with file = \"video.avi\"");
  if (!root.has("video") || root.child("video").json->empty())
    root.fail("[[video]] is missing; give one for each video");
  const Node list = root.child("video");
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    const ActivityVideoFile v = ActivityVideoFile::schema().parse(n);
    const double from = v.from.value_or(study.from.value_or(0));
    const std::optional<double> to = v.to ? v.to : study.to;
    if (to && *to <= from)
      throw Error(Errc::usage, n.where("to"),
                  fmt::format("{:g} s is not later than from = {:g} s", *to, from));
    job.videos.push_back({existing_file(n, "file", v.file), v.exposure, v.experiment,
                          v.direction ? v.direction : study.direction,
                          v.reversal ? v.reversal : study.reversal, from, to});
  }
}

}  // namespace faba
