#include "study/experiment/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/units.h"
#include "study/data/table_list.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr double kLongest = 1e6;  // s

Schema<ExperimentDrop> drop_schema() {
  return Schema<ExperimentDrop>("drop", "A drop of the sample")
      .add("name", &ExperimentDrop::name, {.doc = "Name of the drop"})
      .add("polarity", &ExperimentDrop::polarity,
           {.doc = "How the cells respond to a field: north-seeking cells swim along it, south-seeking cells "
                   "against "
                   "it",
            .choices = {"unknown", "north", "south"}})
      .add("note", &ExperimentDrop::note, {.doc = "Remarks"})
      .check([](const ExperimentDrop& d) -> std::string {
        return d.name.empty() ? "key \"name\" is missing; give the drop a name: name = \"A\"" : "";
      });
}

constexpr const char* kSources[] = {"calibration", "ruler", "typed", "metadata"};
constexpr double kLeastScale = 1e-3, kMostScale = 1e3;  // um/px

FieldInfo error_info() {
  return {.min = 0, .max = kMostScale, .doc = "Standard error of um_per_px, if the scale was measured"};
}
FieldInfo source_info() { return {.doc = fmt::format("Origin of the scale: {}", fmt::join(kSources, ", "))}; }

// What is wrong with the scale of an experiment or video; empty: nothing.
template <class T>
std::string wrong_scale(const T& of) {
  const std::string& s = of.um_per_px_source;
  if (!s.empty() && std::ranges::find(kSources, s) == std::end(kSources))
    return fmt::format("um_per_px_source = \"{}\" must be one of {}", s, fmt::join(kSources, ", "));
  if (!of.um_per_px && of.um_per_px_se)
    return fmt::format("um_per_px_se = {:g} is the standard error of um_per_px, which is missing; give both",
                       *of.um_per_px_se);
  if (of.um_per_px && of.um_per_px_se && *of.um_per_px_se >= *of.um_per_px)
    return fmt::format("um_per_px_se = {:g} must be less than um_per_px = {:g}", *of.um_per_px_se,
                       *of.um_per_px);
  return "";
}

// What is wrong with the order of the segments; empty: nothing.
std::string wrong_order(const std::vector<ExperimentSegment>& segments) {
  for (std::size_t i = 1; i < segments.size(); ++i)
    if (segments[i].from_s < segments[i - 1].to_s)
      return fmt::format("segment = [...]: item {} starts at {:g} s, before item {} ends ({:g} s)", i,
                         segments[i].from_s, i - 1, segments[i - 1].to_s);
  return "";
}

FieldInfo time_info(const char* doc) { return {.unit = "s", .min = 0, .max = kLongest, .doc = doc}; }

Schema<ExperimentVideo> video_schema() {
  using Video = ExperimentVideo;
  return Schema<Video>("video", "A video of the experiment")
      .add("file", &Video::file,
           {.doc = "Video, run directory or file of flows, relative to the folder of the experiment"})
      .add("drop", &Video::drop, {.doc = "Name of the drop that the video shows"})
      .add("exposure", &Video::exposure_s, time_info("Air exposure time of the drop before the video"))
      .add("reversal", &Video::reversal_s, time_info("Time of the field reversal in the video"))
      .add("field_direction", &Video::field_direction,
           {.unit = "rad",
            .min = -2 * M_PI,
            .max = 2 * M_PI,
            .doc = "Direction of the field after the reversal, counter-clockwise: 0 deg is right, 90 deg is "
                   "up in the "
                   "picture"})
      .add("field_strength", &Video::field_strength,
           {.unit = "T", .min = 0, .max = 1, .doc = "Strength of the field"})
      .add("from", &Video::from_s, time_info("Start of the part of the video that is evaluated"))
      .add("to", &Video::to_s, time_info("End of the part of the video that is evaluated"))
      .add("um_per_px", &Video::um_per_px,
           {.min = kLeastScale,
            .max = kMostScale,
            .doc = "Micrometres per pixel, if the video has another scale than the experiment"})
      .add("um_per_px_se", &Video::um_per_px_se, error_info())
      .add("um_per_px_source", &Video::um_per_px_source, source_info())
      .add("segment", &Video::segments,
           {.doc = "[[video.segment]]: field segments, in order, for faba identify"})
      .add("note", &Video::note, {.doc = "Remarks"})
      .check([](const Video& v) -> std::string {
        if (v.file.empty()) return "key \"file\" is missing; specify a video: file = \"videos/a.mp4\"";
        if (v.from_s && v.to_s && *v.to_s <= *v.from_s)
          return fmt::format("to = {:g} s is not later than from = {:g} s", *v.to_s, *v.from_s);
        if (v.reversal_s && v.to_s && *v.reversal_s >= *v.to_s)
          return fmt::format("reversal = {:g} s is not before to = {:g} s", *v.reversal_s, *v.to_s);
        const std::string scale = wrong_scale(v);
        return scale.empty() ? wrong_order(v.segments) : scale;
      });
}

Schema<Experiment> schema() {
  return Schema<Experiment>("experiment", "Videos of drops of one sample, with what is known about them")
      .add("title", &Experiment::title, {.doc = "Title in lists and reports"})
      .add("note", &Experiment::note, {.doc = "Remarks"})
      .add("objective", &Experiment::objective, {.doc = "Objective of the microscope, such as 20x"})
      .add("um_per_px", &Experiment::um_per_px,
           {.min = kLeastScale,
            .max = kMostScale,
            .doc = "Micrometres per pixel; without it lengths are in px"})
      .add("um_per_px_se", &Experiment::um_per_px_se, error_info())
      .add("um_per_px_source", &Experiment::um_per_px_source, source_info())
      .add("noise", &Experiment::noise,
           {.doc = "Video of a dead sample, from which the noise of the flow is measured"})
      .check([](const Experiment& e) { return wrong_scale(e); });
}

void check_names(const Node& root, const Experiment& e) {
  std::set<std::string> drops, files;
  for (std::size_t i = 0; i < e.drops.size(); ++i)
    if (!drops.insert(e.drops[i].name).second)
      root.child("drop").item(i).fail(fmt::format("name = \"{}\" is used by another drop", e.drops[i].name));
  for (std::size_t i = 0; i < e.videos.size(); ++i) {
    const ExperimentVideo& v = e.videos[i];
    if (!files.insert(v.file).second)
      root.child("video").item(i).fail(fmt::format("file = \"{}\" is used by another [[video]]", v.file));
    if (!v.drop.empty() && !drops.contains(v.drop))
      root.child("video").item(i).fail(
          fmt::format("drop = \"{}\" is not the name of a [[drop]] of the experiment", v.drop));
  }
}

}  // namespace

Schema<ExperimentSegment> ExperimentSegment::schema() {
  return Schema<ExperimentSegment>("segment", "A time interval in which the field is constant")
      .add("from", &ExperimentSegment::from_s, time_info("Start time in the video"))
      .add("to", &ExperimentSegment::to_s, time_info("End time in the video"))
      .add("direction", &ExperimentSegment::direction,
           {.unit = "rad",
            .min = -2 * M_PI,
            .max = 2 * M_PI,
            .doc = "Direction in which the cells swim, counter-clockwise: 0 deg is right, 90 deg is up in "
                   "the picture"})
      .check([](const ExperimentSegment& s) -> std::string {
        if (s.to_s > s.from_s) return "";
        return fmt::format("to = {:g} s is not later than from = {:g} s", s.to_s, s.from_s);
      });
}

std::optional<fs::path> experiment_file(const fs::path& path) {
  std::error_code ec;
  if (fs::is_directory(path, ec))
    return fs::is_regular_file(path / kExperimentFile, ec) ? std::optional(path / kExperimentFile)
                                                           : std::nullopt;
  return path.filename() == kExperimentFile ? std::optional(path) : std::nullopt;
}

Experiment read_experiment(const fs::path& file) { return read_experiment(read_toml(file)); }

Experiment read_experiment(const Document& d) {
  const Node root(d);
  Experiment e = schema().parse(root, {"drop", "video"});
  e.drops = tables_of(root, "drop", drop_schema());
  e.videos = tables_of(root, "video", video_schema());
  check_names(root, e);
  return e;
}

Json experiment_schema() {
  Json j = schema().json_schema();
  j["properties"]["drop"] = {{"type", "array"},
                             {"description", "The drops, one [[drop]] each"},
                             {"items", drop_schema().json_schema()}};
  j["properties"]["video"] = {{"type", "array"},
                              {"description", "The videos, one [[video]] each"},
                              {"items", video_schema().json_schema()}};
  return j;
}

fs::path video_path(const fs::path& experiment_file, const ExperimentVideo& video) {
  return experiment_file.parent_path() / video.file;
}

std::optional<VideoScale> scale_of(const Experiment& e, const ExperimentVideo& video) {
  const auto scale = [](const auto& of) {
    const std::string source = of.um_per_px_source.empty() ? "typed" : of.um_per_px_source;
    return VideoScale{of.um_per_px, source, {}, of.um_per_px_se};
  };
  if (video.um_per_px) return scale(video);
  if (!e.um_per_px) return {};
  return scale(e);
}

std::optional<double> swimming_direction_deg(const Experiment& e, const ExperimentVideo& video) {
  const auto drop = std::ranges::find(e.drops, video.drop, &ExperimentDrop::name);
  if (!video.field_direction || drop == e.drops.end() || drop->polarity == CellPolarity::unknown) return {};
  const double along = drop->polarity == CellPolarity::north ? 0 : 180;
  // The angle of the field counts with y up, that of the picture with y down.
  const double deg = std::fmod(along - *video.field_direction * kDegreesPerRadian, 360);
  return deg < 0 ? deg + 360 : deg;
}

}  // namespace faba
