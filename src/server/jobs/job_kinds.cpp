#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "server/jobs/job_kind.h"

namespace faba {
namespace {

using In = JobInput::Kind;

JobInput video_input(const char* key = "video", const char* doc = "Video or recorded run") {
  return {.key = key, .kind = In::video, .required = true, .doc = doc};
}
JobInput videos_input() {
  JobInput i = video_input("videos", "Videos or recorded runs");
  i.many = true;
  return i;
}
JobInput file_input(const char* key, In kind, const char* doc) {
  return {.key = key, .kind = kind, .required = true, .doc = doc};
}
JobInput coils_input() { return file_input("rig", In::coil_system, "Coil system"); }
JobInput study_input() { return file_input("study", In::study, "Study file"); }

JobInput seconds(const char* key, const char* option, const char* doc) {
  return {.key = key, .option = option, .unit = "s", .min = 0, .max = 1e6, .doc = doc};
}
JobInput number(const char* key, const char* option, double min, double max, const char* doc,
                const char* unit = "") {
  return {.key = key, .option = option, .unit = unit, .min = min, .max = max, .doc = doc};
}
JobInput integer(const char* key, const char* option, double min, double max, const char* doc) {
  return {.key = key, .kind = In::integer, .option = option, .min = min, .max = max, .doc = doc};
}
JobInput flag(const char* key, const char* option, const char* doc) {
  return {.key = key, .kind = In::flag, .option = option, .doc = doc};
}
JobInput choice(const char* key, const char* option, std::vector<std::string> words, const char* doc) {
  return {.key = key, .kind = In::choice, .option = option, .choices = std::move(words), .doc = doc};
}
JobInput point(const char* key, const char* option, double min, const char* doc) {
  return {.key = key,
          .kind = In::point,
          .option = option,
          .unit = "mm",
          .shows_unit = true,
          .min = min,
          .max = 1000,
          .doc = doc};
}
JobInput direction_input() {
  return {.key = "direction",
          .kind = In::direction,
          .option = "--direction",
          .unit = "deg",
          .min = -360,
          .max = 360,
          .doc =
              "Direction in which the cells swim in the picture after the field reversal, "
              "counter-clockwise: 0 deg is right, 90 deg is up; default: measured"};
}

std::vector<JobInput> with_part(std::vector<JobInput> inputs) {
  inputs.push_back(seconds("from", "--from", "Start of the part of the video that is used; default: 0 s"));
  inputs.push_back(
      seconds("to", "--to", "End of the part of the video that is used; default: end of the video"));
  inputs.push_back(number("fps", "--fps", 0.001, 1e6,
                          "Frames per second, for a video that states none or a wrong one; default: that of "
                          "the video"));
  return inputs;
}

// Run times below are assumed, after single runs on two cores; those of jobs that end replace them.
std::vector<JobKind> video_kinds() {
  JobInput noise = video_input("noise", "Video of a dead sample, from which the threshold is measured");
  noise.option = "--noise";
  noise.required = false;
  return {
      {.name = "activity",
       .group = "videos",
       .verb = {"activity"},
       .doc = "Measures when cells move in one direction after a field reversal, and how much",
       .inputs = with_part({videos_input(), direction_input(),
                            seconds("reversal", "--reversal",
                                    "Time of the field reversal in the video; default: as recorded by a run, "
                                    "else unknown"),
                            noise}),
       .outputs = {{"--report", "report.html"}, {"--out", "signature.csv"}},
       .page = "report.html",
       .work = JobWork::pixels,
       .fixed_s = 0.5,
       .s_per_work = 0.12},
      {.name = "activity-exposure",
       .group = "videos",
       .verb = {"activity"},
       .doc = "Measures the activity of all videos of an experiment against the air exposure time",
       .inputs = {file_input("experiment", In::experiment, "Experiment")},
       .outputs = {{"--report", "report.html"}, {"--out", "signature.csv"}},
       .page = "report.html",
       .work = JobWork::pixels,
       .fixed_s = 0.5,
       .s_per_work = 0.12},
      {.name = "compare",
       .group = "videos",
       .verb = {"compare"},
       .doc = "Distance between the motion in videos and the motion in a reference, frame by frame",
       .inputs = with_part({video_input("reference", "Video or recorded run, the reference"), videos_input(),
                            direction_input()}),
       .outputs = {{"--report", "report.html"}, {"--out", "distances.csv"}},
       .page = "report.html",
       .work = JobWork::pixels,
       .fixed_s = 1,
       .s_per_work = 0.2},
      {.name = "track",
       .group = "videos",
       .verb = {"track"},
       .doc = "Detects and tracks cells or beads and measures how they move",
       .inputs = with_part(
           {video_input(),
            number("um_per_px", "--um-per-px", 1e-3, 1e3,
                   "Micrometres per pixel; default: that of a run, else results in px"),
            number("size", "--size", 1, 1000, "Full width of a cell at half its contrast; default: measured",
                   "px"),
            choice("polarity", "--polarity", {"auto", "dark", "bright", "both"},
                   "Cells are dark, bright or both on the background; default: auto, measured"),
            number("threshold", "--threshold", 0.1, 1000,
                   "Minimum signal-to-noise ratio of a spot; default: the value that gives one false "
                   "detection in 10 frames"),
            number("reach", "--reach", 0.1, 10000,
                   "Maximum displacement between two frames; default: measured", "px"),
            choice("motion", "--motion", {"auto", "nearest", "velocity"},
                   "Predict positions by velocity, or use the nearest spot; default: auto, chosen for the "
                   "video"),
            integer("memory", "--memory", 0, 1000,
                    "Maximum number of consecutive frames without a detection of the cell; default: 2"),
            integer("least", "--least", 1, 100000, "Minimum number of detections of a track; default: 3"),
            flag("drop", "--drop", "Search only inside the edge of the drop"),
            flag("keep_drift", "--keep-drift", "Do not subtract the motion of the stage")}),
       .outputs = {{"--report", "report.html"},
                   {"--out", "tracks.csv"},
                   {"--per-track", "per_track.csv"},
                   {"--picture", "tracks.png"}},
       .page = "report.html",
       .work = JobWork::pixels,
       .fixed_s = 0.5,
       .s_per_work = 0.07},
      {.name = "flow",
       .group = "videos",
       .verb = {"flow"},
       .doc = "Computes the optical flow from frame to frame of a video",
       .inputs = with_part({video_input()}),
       .outputs = {{"--out", "flow.h5"}, {"--overlay", "arrows.mp4"}},
       .page = "arrows.mp4",
       .work = JobWork::pixels,
       .fixed_s = 0.5,
       .s_per_work = 0.15},
      {.name = "flow-pictures",
       .group = "videos",
       .verb = {"flow"},
       .doc = "Computes the optical flow between two pictures",
       .inputs = {file_input("first", In::picture, "First picture"),
                  file_input("second", In::picture, "Second picture")},
       .outputs = {{"--out", "flow.flo"}, {"--picture", "flow.png"}},
       .page = "flow.png",
       .fixed_s = 1},
      {.name = "scale",
       .group = "videos",
       .verb = {"scale"},
       .doc = "Determines micrometres per pixel from a picture of a ruler",
       .inputs = {file_input("ruler", In::picture, "Picture of a ruler"),
                  {.key = "tick",
                   .option = "--tick",
                   .required = true,
                   .unit = "um",
                   .shows_unit = true,
                   .min = 0.01,
                   .max = 1e5,
                   .doc = "Distance between neighbouring marks of the finest division"}},
       .outputs = {{"--out", "calibration.toml"}, {"--overlay", "marks.png"}},
       .page = "marks.png",
       .fixed_s = 1},
      {.name = "scale-table",
       .group = "videos",
       .verb = {"scale"},
       .doc = "Determines micrometres per pixel from readings: a table with the columns width_um, px_1, px_2",
       .inputs = {file_input("ruler", In::table, "Readings, as CSV")},
       .outputs = {{"--out", "calibration.toml"}},
       .page = "",
       .fixed_s = 0.2},
      {.name = "drop",
       .group = "videos",
       .verb = {"drop"},
       .doc = "Detects the edge of a drop in a picture or in the first frame of a video",
       .inputs = {file_input("picture", In::frame, "Picture or video of the drop")},
       .outputs = {{"--overlay", "edge.png"}},
       .page = "edge.png",
       .fixed_s = 1}};
}

std::vector<JobKind> study_kinds() {
  return {{.name = "identify",
           .group = "models",
           .verb = {"identify"},
           .doc = "Finds which model and which parameters explain videos of step responses",
           .inputs = {study_input()},
           .outputs = {{"--out", ""}},
           .page = "identify.html",
           .work = JobWork::simulations,
           .study = JobStudy::identification,
           .fixed_s = 2,
           .s_per_work = 0.012},
          {.name = "compare-controllers",
           .group = "control",
           .verb = {"compare-controllers"},
           .doc = "Compares controllers, models, camera delays or values of parameters, each over many seeds",
           .inputs = {study_input()},
           .outputs = {{"--out", ""}},
           .page = "report.html",
           .work = JobWork::cell_frames,
           .study = JobStudy::controllers,
           .fixed_s = 1,
           .s_per_work = 0.15}};
}

std::vector<JobKind> coil_kinds() {
  const JobInput at = point("at", "--at", -1000, "Position in the plane of the sample; default: the centre");
  JobInput map =
      file_input("map", In::table, "Measured field: positions and components, or a scan along an axis");
  map.option = "--map";
  return {
      {.name = "field-map",
       .group = "coils",
       .verb = {"field", "map"},
       .doc = "Maps the field in the plane of the sample",
       .inputs = {coils_input(),
                  {.key = "current",
                   .kind = In::currents,
                   .option = "--current",
                   .unit = "A",
                   .min = -1e4,
                   .max = 1e4,
                   .doc = "Currents, one for each coil; default: those of the file"},
                  point("size", "--size", 1e-3,
                        "Width and height of the rectangle around the centre; default: 6 mm, 4.5 mm")},
       .outputs = {{"--picture", "field.png"}, {"--out", "field.h5"}},
       .page = "field.png",
       .fixed_s = 1},
      {.name = "field-null",
       .group = "coils",
       .verb = {"field", "null"},
       .doc = "Computes the currents that produce a zero of the field at a position and trap cells there",
       .inputs = {coils_input(), at,
                  choice("polarity", "--polarity", {"north", "south"},
                         "Cells to trap: north-seeking or south-seeking; default: north")},
       .outputs = {},
       .page = "",
       .fixed_s = 0.2},
      {.name = "field-tolerance",
       .group = "coils",
       .verb = {"field", "tolerance"},
       .doc = "Displacement of a zero of the field when the coil system deviates from its file",
       .inputs = {coils_input(), at},
       .outputs = {{"--picture", "tolerance.svg"}},
       .page = "tolerance.svg",
       .fixed_s = 0.3},
      {.name = "field-fit",
       .group = "coils",
       .verb = {"field", "fit"},
       .doc = "Fits gain, shift and background field of a coil system to a measured field",
       .inputs = {coils_input(),
                  map,
                  {.key = "columns",
                   .kind = In::words,
                   .option = "--columns",
                   .doc = "Names of the columns of a text file, in order, such as x,y,z,bx,by,bz; default: "
                          "those in its header"},
                  {.key = "units",
                   .kind = In::words,
                   .option = "--units",
                   .doc = "Units of the columns, or one of length and one of field, such as cm,G; default: "
                          "those in the header"}},
       .outputs = {{"--out", "fitted.toml"}, {"--picture", "residual.svg"}},
       .page = "residual.svg",
       .fixed_s = 0.5},
      {.name = "field-library",
       .group = "coils",
       .verb = {"field", "library"},
       .doc = "Computes many sets of currents and their zeros of the field",
       .inputs = {coils_input(),
                  point("size", "--size", 1e-3,
                        "Width and height of the rectangle of the zeros; default: 2 mm, 2 mm"),
                  integer("levels", "--levels", 1, 100000,
                          "Number of steps from zero current to the maximum; default: the largest number up "
                          "to 100 with at most 4 million sets of currents")},
       .outputs = {{"--out", "library.h5"}},
       .page = "",
       .work = JobWork::sets,
       .fixed_s = 0.3,
       .s_per_work = 3}};
}

}  // namespace

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> all = [] {
    std::vector<JobKind> kinds = video_kinds();
    for (auto make : {study_kinds, coil_kinds})
      for (JobKind& k : make()) kinds.push_back(std::move(k));
    return kinds;
  }();
  return all;
}

const JobKind& job_kind(std::string_view name) {
  std::string known;
  for (const JobKind& k : job_kinds()) {
    if (k.name == name) return k;
    known += (known.empty() ? "" : ", ") + k.name;
  }
  throw Error(Errc::usage, "kind",
              fmt::format("\"{}\" is not a kind of job; it must be one of {}", name.substr(0, 80), known));
}

}  // namespace faba
