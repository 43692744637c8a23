#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/scenario/calibration_file.h"
#include "app/scenario/file_kind.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/error.h"
#include "core/units.h"
#include "study/identify/families/nuisances.h"
#include "study/identify/identify_study.h"
#include "study/identify/parameter_search.h"

namespace faba {
namespace {

// Key of a [[model]], and its name in the previous version, which is still read.
constexpr const char* kFieldStrength = "field_strength";
constexpr const char* kOldFieldStrength = "drive";

// Relative standard deviation of the number of cells that is detected in the first frame (assumed): at the
// dark edge of a drop a third of the cells can be missed.
constexpr double kCountUncertainty = 0.4;
constexpr double kNormal95 = 1.96;  // half of a 95 % interval, in standard deviations

// Tables of a scenario that are not determined by the video.
constexpr const char* kOfScene[] = {"exclusion", "field", "library", "limits", "motility", "simulation"};

struct IdentifyFile {
  std::string title;
  std::uint64_t seed = 1;
  Boundary boundary = Boundary::drop;
  Look look = Look::video;
  std::optional<Measure> measure;
  int simulations = 600;
  bool legacy = false, nuisances = true;
  std::optional<double> scale_uncertainty;
  double field_uncertainty = 0;
  std::optional<double> um_per_px, reversal, direction, duration, timing;
  std::string scale, calibration;
  std::optional<double> field_strength;
  static Schema<IdentifyFile> schema() {
    return Schema<IdentifyFile>("identify", "Model selection and parameter estimation from videos")
        .add("title", &IdentifyFile::title, {.doc = "Title of the study in reports"})
        .add("seed", &IdentifyFile::seed, {.min = 0, .max = 9e15, .doc = "Seed of all random numbers"})
        .add("boundary", &IdentifyFile::boundary,
             {.doc = "Boundary that confines the cells", .choices = {"drop", "box", "none"}})
        .add("look", &IdentifyFile::look,
             {.doc = "How simulations are observed: as frames rendered through the microscope, like the "
                     "videos, or as positions of the cells, which is faster but has no camera effects",
              .choices = {"video", "positions"}})
        .add(
            "measure", &IdentifyFile::measure,
            {.doc =
                 "Statistics for the comparison: distribution of the swarm in the picture (density), or "
                 "motion of cells in short tracks (tracks); default: tracks without a boundary, else density",
             .choices = {"density", "tracks"}})
        .add("simulations", &IdentifyFile::simulations,
             {.min = 100, .max = 1e6, .doc = "Number of simulations of each video with each model"})
        .add("legacy", &IdentifyFile::legacy,
             {.doc = "Apply the selection rule of the 2016 thesis as well; it is not reliable"})
        .add("nuisances", &IdentifyFile::nuisances,
             {.doc = "Estimate what is different in every culture as well, unless the model fixes it: motile "
                     "fraction, responsive fraction and spread of the speed; and sample the number of cells"})
        .add("scale_uncertainty", &IdentifyFile::scale_uncertainty,
             {.min = 0,
              .max = 0.5,
              .doc = "Relative standard deviation of the scale, which each simulation samples; default: that "
                     "of the calibration file, else 0"})
        .add("field_uncertainty", &IdentifyFile::field_uncertainty,
             {.min = 0,
              .max = 0.5,
              .doc = "Relative standard deviation of the field strength, which each simulation samples"})
        .add("calibration", &IdentifyFile::calibration,
             {.doc = "Result of `faba calibrate` for this study, calibration.json, which the page shows"})
        .add("um_per_px", &IdentifyFile::um_per_px, {.min = 1e-3, .max = 1e3, .doc = "Micrometres per pixel"})
        .add("scale", &IdentifyFile::scale, {.doc = "Calibration file of `faba scale`, instead of um_per_px"})
        .add("reversal", &IdentifyFile::reversal,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Time of the field reversal"})
        .add("direction", &IdentifyFile::direction,
             {.unit = "deg",
              .min = -360,
              .max = 360,
              .doc = "Swimming direction after the field reversal: 0 right, 90 down in the picture"})
        .add(
            "duration", &IdentifyFile::duration,
            {.unit = "s", .min = 0.1, .max = 1e6, .doc = "Duration of the analysis after the field reversal"})
        .add("timing", &IdentifyFile::timing,
             {.unit = "s",
              .min = 0,
              .max = 10,
              .doc =
                  "Standard deviation of the times of field reversals; default: 0.58 frames (uniform within "
                  "one frame), or 1.5 frames for segments that are detected in the video"})
        .add("field_strength", &IdentifyFile::field_strength,
             {.unit = "T",
              .min = 0,
              .max = 1,
              .doc = "Field strength; default: the field strength that the run recorded, else 1 mT",
              .old_key = "drive"});
  }
};

struct SegmentFile {
  double from = 0, to = 0, direction = 0;
  static Schema<SegmentFile> schema() {
    return Schema<SegmentFile>(
               "segment", "A field segment: a time interval in which the direction of the field is constant")
        .add("from", &SegmentFile::from,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Start time in the video"})
        .add("to", &SegmentFile::to, {.unit = "s", .min = 0, .max = 1e6, .doc = "End time in the video"})
        .add("direction", &SegmentFile::direction,
             {.unit = "deg",
              .min = -360,
              .max = 360,
              .doc = "Swimming direction: 0 right, 90 down in the picture"});
  }
};

struct VideoFile {
  std::string file, experiment;
  double exposure = 0, fps = 0, from = 0;
  std::optional<double> to, um_per_px, reversal, direction, duration;
  std::vector<SegmentFile> segment;
  static Schema<VideoFile> schema() {
    return Schema<VideoFile>("video", "A video of an experiment")
        .add("file", &VideoFile::file, {.doc = "Video or run directory; relative to the study file"})
        .add("experiment", &VideoFile::experiment,
             {.doc = "Name of the experiment (one drop) that the video belongs to"})
        .add("exposure", &VideoFile::exposure,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Air exposure time before the video"})
        .add("from", &VideoFile::from,
             {.unit = "s",
              .min = 0,
              .max = 1e6,
              .doc = "Start of the part of the video that is used; default: start of the video"})
        .add("to", &VideoFile::to,
             {.unit = "s",
              .min = 0,
              .max = 1e6,
              .doc = "End of the part of the video that is used; default: end of the video"})
        .add("fps", &VideoFile::fps,
             {.min = 0, .max = 1e6, .doc = "Frames per second, for a video without a frame rate"})
        .add("um_per_px", &VideoFile::um_per_px, {.min = 1e-3, .max = 1e3, .doc = "Micrometres per pixel"})
        .add("reversal", &VideoFile::reversal,
             {.unit = "s", .min = 0, .max = 1e6, .doc = "Time of the field reversal"})
        .add("direction", &VideoFile::direction,
             {.unit = "deg", .min = -360, .max = 360, .doc = "Swimming direction after the field reversal"})
        .add("duration", &VideoFile::duration,
             {.unit = "s", .min = 0.1, .max = 1e6, .doc = "Duration of the analysis"})
        .add("segment", &VideoFile::segment,
             {.doc = "[[video.segment]]: field segments, instead of reversal, direction and duration",
              .old_key = "drive"});
  }
};

ResponseInput input_of(const Node& n, const IdentifyFile& study, std::optional<double> um_per_px,
                       bool must_exist) {
  const VideoFile v = VideoFile::schema().parse(n);
  if (v.file.empty()) n.fail("key \"file\" is missing; specify a video: file = \"video.avi\"");
  ResponseInput r;
  if (!v.segment.empty() && (v.reversal || v.direction || v.duration))
    n.fail("segment cannot be combined with reversal, direction or duration; give only one of the two");
  if (must_exist && !std::filesystem::exists(n.file(v.file)))
    throw Error(Errc::input, n.where("file"),
                fmt::format("file not found: {} (relative to the study file)", v.file));
  r.file = n.file(v.file);
  r.where = n.where();
  r.experiment = v.experiment;
  r.exposure_s = v.exposure;
  r.part = {v.from, v.to, v.fps};
  if (v.to && *v.to <= v.from)
    n.fail(fmt::format("ends at {:g} s, but starts at {:g} s; \"to\" must be later than \"from\"", *v.to,
                       v.from));
  r.um_per_px = v.um_per_px ? v.um_per_px : um_per_px;
  r.reversal_s = v.reversal ? v.reversal : study.reversal;
  r.direction_deg = v.direction ? v.direction : study.direction;
  r.duration_s = v.duration ? v.duration : study.duration;
  double last = 0;
  for (std::size_t i = 0; i < v.segment.size(); ++i) {
    const Node at = n.child(n.has("segment") ? "segment" : "drive").item(i);
    const SegmentFile& d = v.segment[i];
    if (d.from < last)
      at.fail(fmt::format("starts at {:g} s, before segment[{}] ends ({:g} s)", d.from, int(i) - 1, last));
    if (!(d.to > d.from))
      at.fail(fmt::format("ends at {:g} s, but starts at {:g} s; \"to\" must be later than \"from\"", d.to,
                          d.from));
    r.segments.push_back({d.from, last = d.to, d.direction});
  }
  return r;
}

// Placeholder video to check scenarios with.
ResponseVideo any_video() {
  ResponseVideo v;
  v.view.width = 64;
  v.view.height = 48;
  v.fps = 15;
  v.um_per_px = 1;
  v.edge.emplace();
  v.edge->centre_image = {32, 24};
  v.edge->radius_px = 100;
  v.cell_px = 3;
  v.contrast = -0.4;
  v.episodes.push_back({"any", 0, {{0, 1, 0}}, {{32, 24}}});
  return v;
}

// The number of populations of a candidate, for episode_scenario().
void check_populations(const Variant& model, const Node& here) {
  if (!model.extra.contains(kPopulations)) return;
  constexpr int kMost = 4;
  const Json& n = model.extra[kPopulations];
  if (!n.is_number_integer() || n.get<int>() < 1 || n.get<int>() > kMost)
    here.fail(fmt::format("populations must be an integer from 1 to {}", kMost));
}

Candidate candidate_of(const Variant& model, const IdentifyFile& f, const IdentifyStudy& study,
                       const Node& root, std::size_t index) {
  Candidate c{model, f.field_strength, {}, {}};
  const Node here = root.has("model") ? root.child("model").item(index) : root;
  if (model.extra.contains(kFieldStrength) && model.extra.contains(kOldFieldStrength))
    here.fail("field_strength and drive (its old name) are both given; give only one");
  const char* key = model.extra.contains(kOldFieldStrength) ? kOldFieldStrength : kFieldStrength;
  if (model.extra.contains(key)) {
    const Node n{c.model.extra[key], here.path + "." + key, root.document};
    c.field_strength_t = schema_detail::read_number(n, {.unit = "T", .min = 0, .max = 1});
  }
  check_populations(model, here);
  const Parts& parts = builtin_parts();
  if (!c.model.part.is_null()) (void)parts.model.resolve({c.model.part, here.path, root.document});
  const ResponseVideo video = any_video();
  Document d = episode_scenario(video, video.episodes[0],
                                {study.boundary, study.scene, c.model, kDefaultFieldStrength},
                                exact_timing(video.episodes[0]));
  d.root["microscope"].erase("background");
  if (c.model.extra.contains("free"))
    c.free = read_free_parameters({c.model.extra["free"], here.path + ".free", root.document}, d.root);
  if (c.free.empty())
    throw Error(Errc::usage, c.model.origin,
                "no free parameters; give free = { \"swarm[0].model.speed\" = [\"20 um/s\", \"300 um/s\"] } "
                "or another path of the scenario");
  if (c.model.extra.contains("legacy")) {
    const Node n{c.model.extra["legacy"], here.path + ".legacy", root.document};
    if (!n.json->is_array() || n.json->size() < 3)
      n.fail("must be a list of at least three values of the first free parameter");
    for (std::size_t i = 0; i < n.json->size(); ++i)
      c.legacy_values.push_back(read_value(n.item(i), c.free.front()));
  }
  if (const int least = ParameterSearch::least_simulations(int(c.free.size())); study.simulations < least)
    throw Error(Errc::usage, c.model.origin,
                fmt::format("{} free parameters need at least {} simulations, not {}", c.free.size(), least,
                            study.simulations));
  const bool has_field = c.field_strength_t.value_or(kDefaultFieldStrength) > 0;
  if (f.nuisances)
    for (FreeParameter& p : default_nuisances(c.free, c.model, has_field, d.root))
      c.free.push_back(std::move(p));
  c.simulations = std::max(study.simulations, ParameterSearch::least_simulations(int(c.free.size())));
  // The middle and both ends of every range must give a valid scenario.
  for (const double u : {0.5, 0.0, 1.0}) {
    Document one = d;
    for (const FreeParameter& p : c.free) one.set(p.path, p.json(u), c.model.origin + ".free");
    try {
      (void)read_scenario(one, parts);
    } catch (const Error& e) {
      std::string values;
      for (const FreeParameter& p : c.free)
        values += fmt::format("{}{} = {:.4g}{}{}", values.empty() ? "" : ", ", p.path, p.shown(p.value(u)),
                              p.shown_unit().empty() ? "" : " ", p.shown_unit());
      throw Error(Errc::usage, c.model.origin,
                  fmt::format("the free ranges permit {}, which is not valid: {}; give narrower ranges",
                              values, e.what()));
    }
  }
  return c;
}

}  // namespace

IdentifyStudy read_identify_study(const std::filesystem::path& file, bool needs_videos) {
  const Document d = read_toml(file);
  const Node root(d);
  require_kind(root, FileKind::identify_study);
  const IdentifyFile f = IdentifyFile::schema().parse(root, {"video", "model", "scene"});
  IdentifyStudy study;
  study.title = f.title.empty() ? file.stem().string() : f.title;
  study.seed = f.seed;
  study.boundary = f.boundary;
  study.look = f.look;
  study.simulations = f.simulations;
  study.measure = f.measure.value_or(f.boundary == Boundary::none ? Measure::tracks : Measure::density);
  study.timing_s = f.timing;
  study.legacy = f.legacy;
  if (!f.calibration.empty()) study.calibration = root.file(f.calibration);
  study.scale_sd = f.scale_uncertainty.value_or(0);
  study.field_sd = f.field_uncertainty;
  study.count_sd = f.nuisances ? kCountUncertainty : 0;
  if (root.has("scene")) {
    if (!root.child("scene").json->is_object())
      root.child("scene").fail("must be a table of scenario tables");
    study.scene = *root.child("scene").json;
    for (const auto& [key, _] : study.scene.items())
      if (std::find(std::begin(kOfScene), std::end(kOfScene), key) == std::end(kOfScene))
        throw Error(
            Errc::usage, root.child("scene").where(key),
            fmt::format(
                "is not permitted in [scene]: it is taken from the video or has no effect; permitted: {}",
                fmt::join(kOfScene, ", ")));
  }
  std::optional<double> um_per_px = f.um_per_px;
  if (!f.scale.empty()) {
    if (um_per_px) root.fail("um_per_px and scale are both given; give only one");
    const Calibration calibration = parse_calibration(root.file(f.scale).string(), root.where("scale"));
    um_per_px = calibration.um_per_px;
    if (calibration.ci95 && !f.scale_uncertainty)
      study.scale_sd = (calibration.ci95->y - calibration.ci95->x) / (2 * kNormal95 * *um_per_px);
  }
  if (root.has("video") && !root.child("video").json->is_array())
    root.child("video").fail("must be an array of tables; write [[video]] with file = \"video.avi\"");
  if (!root.has("video") || root.child("video").json->empty())
    root.fail("[[video]] is missing; give one for each video");
  const Node videos = root.child("video");
  std::set<std::filesystem::path> seen;
  for (std::size_t i = 0; i < videos.json->size(); ++i) {
    study.videos.push_back(input_of(videos.item(i), f, um_per_px, needs_videos));
    if (!seen.insert(std::filesystem::weakly_canonical(study.videos.back().file)).second)
      videos.item(i).fail("duplicate video; it would count as another experiment");
  }
  if (!root.has("model")) root.fail("[[model]] is missing; give one for each candidate");
  const std::vector<Variant> models =
      read_variants(root, "model", {"free", kFieldStrength, kOldFieldStrength, "legacy", kPopulations});
  for (std::size_t i = 0; i < models.size(); ++i)
    study.candidates.push_back(candidate_of(models[i], f, study, root, i));
  return study;
}

Json identify_study_schema() {
  Json j = IdentifyFile::schema().json_schema();
  Json& p = j["properties"];
  p["scene"] = {{"type", "object"},
                {"description",
                 fmt::format("Tables of a scenario that all models share: {}", fmt::join(kOfScene, ", "))}};
  Json video = VideoFile::schema().json_schema();
  p["video"] = {{"type", "array"}, {"description", "One [[video]] for each video"}, {"items", video}};
  Json model = variant_schema("A candidate");
  model["properties"]["free"] = {{"type", "object"},
                                 {"description",
                                  "Free parameters by path: [lowest, highest], true for the range in the "
                                  "reference, or { mean, sd } of a normal prior"}};
  model["properties"][kFieldStrength] = {{"type", "string"},
                                         {"description", "Field strength for this model"}};
  model["properties"]["legacy"] = {
      {"type", "array"},
      {"items", {{"type", "number"}}},
      {"description", "Values of the first free parameter for the rule of the thesis"}};
  model["properties"][kPopulations] = {
      {"type", "integer"},
      {"description",
       "Number of swarms with equal numbers of cells; the parameters of the second one have paths such as "
       "swarm[1].model.speed"}};
  p["model"] = {{"type", "array"}, {"description", "One [[model]] for each candidate"}, {"items", model}};
  return j;
}

}  // namespace faba
