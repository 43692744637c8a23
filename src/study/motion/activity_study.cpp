#include "study/motion/activity_study.h"

#include <optional>
#include <string>

#include "app/scenario/parts.h"
#include "core/toml.h"

namespace faba {
namespace {

struct ActivityVideoFile {
  std::string file, experiment;
  std::optional<double> exposure, direction, from, to;
  static Schema<ActivityVideoFile> schema() {
    return Schema<ActivityVideoFile>("video", "One video of the study")
        .add("file", &ActivityVideoFile::file,
             {.doc = "Video, run directory or file of flows; beside the study file"})
        .add("exposure", &ActivityVideoFile::exposure,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Time of the sample in air before the video"})
        .add("experiment", &ActivityVideoFile::experiment,
             {.doc = "Which experiment, that is which drop, it belongs to"})
        .add("direction", &ActivityVideoFile::direction,
             {.unit = "deg",
              .min = -360,
              .max = 360,
              .doc = "Direction of the response: 0 right, 90 down in the picture"})
        .add("from", &ActivityVideoFile::from,
             {.unit = "s",
              .min = 0,
              .max = 1e9,
              .doc = "Leave out what comes before, and count time from here"})
        .add("to", &ActivityVideoFile::to,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "Leave out what comes after"})
        .check([](const ActivityVideoFile& v) -> std::string {
          return v.file.empty() ? "needs file = \"a video\"" : "";
        });
  }
};

struct ActivityFile {
  std::optional<double> direction, threshold, from, to;
  std::string noise;
  static Schema<ActivityFile> schema() {
    return Schema<ActivityFile>("study", "Videos of samples after different times in air")
        .add("direction", &ActivityFile::direction,
             {.unit = "deg", .min = -360, .max = 360, .doc = "For all videos that give none"})
        .add("from", &ActivityFile::from,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "For all videos that give none"})
        .add("to", &ActivityFile::to,
             {.unit = "s", .min = 0, .max = 1e9, .doc = "For all videos that give none"})
        .add("threshold", &ActivityFile::threshold,
             {.unit = "px", .min = 0, .max = 1e3, .doc = "Flows of less are noise"})
        .add("noise", &ActivityFile::noise, {.doc = "A video of a dead sample, to find the threshold from"})
        .check([](const ActivityFile& s) -> std::string {
          return s.threshold && !s.noise.empty() ? "give threshold or noise, not both" : "";
        });
  }
};

}  // namespace

Json activity_study_schema() {
  Json j = ActivityFile::schema().json_schema();
  j["properties"]["video"] = {{"type", "array"},
                              {"description", "[[video]], once for each"},
                              {"items", ActivityVideoFile::schema().json_schema()}};
  return j;
}

void read_activity_study(const std::filesystem::path& file, ActivityJob& job) {
  const Document d = read_toml(file);
  const Node root(d);
  const ActivityFile study = ActivityFile::schema().parse(root, {"video", "flow"});
  if (root.has("flow")) job.method = builtin_parts().flow.resolve(root.child("flow"));
  if (study.threshold) job.threshold_px = study.threshold;
  if (!study.noise.empty()) job.noise = root.file(study.noise);
  if (!root.has("video") || !root.child("video").json->is_array() || root.child("video").json->empty())
    root.fail("needs [[video]], once for each video");
  const Node list = root.child("video");
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    const ActivityVideoFile v = ActivityVideoFile::schema().parse(n);
    job.videos.push_back({n.file(v.file), v.exposure, v.experiment,
                          v.direction ? v.direction : study.direction,
                          v.from.value_or(study.from.value_or(0)), v.to ? v.to : study.to});
  }
}

}  // namespace faba
