#include "study/uturn/moment_study.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scenario/file_kind.h"
#include "core/schema.h"
#include "core/toml.h"
#include "vision/files/picture_sequence.h"

namespace faba {
namespace {

struct CellFile {
  std::optional<double> radius, length, width, drag_sd;
  double size_sd = 0.05, viscosity = 0.89e-3, drag_factor = 1;
  static Schema<CellFile> schema() {
    return Schema<CellFile>("cell", "The body of the cells, from which the rotational drag follows")
        .add(
            "radius", &CellFile::radius,
            {.unit = "m", .min = 1e-8, .max = 1e-4, .doc = "Radius of a coccus, instead of length and width"})
        .add("length", &CellFile::length,
             {.unit = "m", .min = 1e-8, .max = 1e-3, .doc = "Length of a rod, end to end"})
        .add("width", &CellFile::width, {.unit = "m", .min = 1e-8, .max = 1e-3, .doc = "Width of a rod"})
        .add("size_sd", &CellFile::size_sd,
             {.min = 0,
              .max = 1,
              .doc = "Relative standard deviation of the size; the drag has three times of it",
              .source = "assumed: 0.07 um of 1.4 um"})
        .add("drag_sd", &CellFile::drag_sd,
             {.min = 0, .max = 2, .doc = "Relative standard deviation of the drag; default: 3 size_sd"})
        .add("drag_factor", &CellFile::drag_factor,
             {.min = 1,
              .max = 100,
              .doc = "Rotational drag with flagella over that of the body",
              .source = "assumed"})
        .add("viscosity", &CellFile::viscosity,
             {.unit = "Pa s",
              .min = 1e-5,
              .max = 10,
              .doc = "Viscosity of the medium",
              .source = "water at 25 degC"})
        .check([](const CellFile& c) -> std::string {
          if (c.radius && (c.length || c.width)) return "specify either radius or length and width, not both";
          if (c.radius) return "";
          if (!c.length || !c.width) return "needs radius, or length and width";
          return *c.length < *c.width ? "length must not be less than width" : "";
        });
  }
};

struct MomentVideoFile {
  std::string file;
  double field = 0, fps = 0;
  std::vector<double> reversals;
  static Schema<MomentVideoFile> schema() {
    return Schema<MomentVideoFile>("video", "One video of cells in a field that is reversed")
        .add("file", &MomentVideoFile::file,
             {.doc = "Video or run directory, relative to the folder of the study file"})
        .add("field", &MomentVideoFile::field,
             {.unit = "T", .min = 0, .max = 10, .doc = "Strength of the field"})
        .add("reversals", &MomentVideoFile::reversals,
             {.unit = "s",
              .min = 0,
              .max = 1e6,
              .doc = "Times of the field reversals in the video, ascending"})
        .add("fps", &MomentVideoFile::fps,
             {.unit = "Hz", .min = 0, .max = 1e6, .doc = "Frame rate; default: that of the video"})
        .check([](const MomentVideoFile& v) -> std::string {
          if (v.file.empty()) return "key \"file\" is missing; specify a video: file = \"video.avi\"";
          if (!(v.field > 0)) return "key \"field\" is missing; specify the field: field = \"0.05 mT\"";
          if (v.reversals.empty())
            return "key \"reversals\" is missing; specify the times of the field reversals: reversals = [\"2 "
                   "s\"]";
          return std::is_sorted(v.reversals.begin(), v.reversals.end()) ? "" : "reversals must be ascending";
        });
  }
};

struct MomentFile {
  double field_sd = 0;
  std::optional<CellFile> cell;
  static Schema<MomentFile> schema() {
    return Schema<MomentFile>("study", "U-turns at several field strengths")
        .add("field_sd", &MomentFile::field_sd,
             {.min = 0, .max = 1, .doc = "Relative standard deviation of the calibration of the field"})
        .add("cell", &MomentFile::cell,
             {.doc = "Body of the cells; without it only the turning rate is estimated"});
  }
};

CellBody body_of(const CellFile& c) {
  return {.length = c.radius ? 2 * *c.radius : *c.length,
          .width = c.radius ? 2 * *c.radius : *c.width,
          .viscosity = c.viscosity,
          .drag_factor = c.drag_factor,
          .drag_sd = c.drag_sd.value_or(3 * c.size_sd)};
}

}  // namespace

nlohmann::ordered_json moment_study_schema() {
  Json j = MomentFile::schema().json_schema();
  j["properties"]["video"] = {{"type", "array"},
                              {"description", "The videos, one [[video]] each"},
                              {"items", MomentVideoFile::schema().json_schema()}};
  return j;
}

void read_moment_study(const std::filesystem::path& file, MomentJob& job) {
  const Document d = read_toml(file);
  const Node root(d);
  require_kind(root, FileKind::moment_study);
  const MomentFile study = MomentFile::schema().parse(root, {"video"});
  job.field_sd = study.field_sd;
  if (study.cell) job.cell = body_of(*study.cell);
  if (!root.has("video") || !root.child("video").json->is_array() || root.child("video").json->empty())
    root.fail("[[video]] is missing; give one for each field strength");
  const Node list = root.child("video");
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node n = list.item(i);
    const MomentVideoFile v = MomentVideoFile::schema().parse(n);
    const auto path = n.file(v.file);
    std::error_code ec;
    if (!std::filesystem::exists(path, ec) && !is_picture_sequence(path))
      throw Error(Errc::input, n.where("file"),
                  fmt::format("file not found: {} (relative to the study file)", v.file));
    job.videos.push_back({path, v.field, v.reversals, v.fps});
  }
}

}  // namespace faba
