#pragma once
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace faba::cli {

/// What every verb takes.
struct Common {
  bool json = false;   ///< one JSON object on standard output and nothing else there
  bool quiet = false;  ///< no progress bar, no notes, no summary
};

struct RunVerb {
  std::string scene;
  std::vector<std::string> set;  ///< "path=value"
  std::optional<std::string> seed, duration;
  unsigned threads = 0;
  std::filesystem::path out;
  std::filesystem::path from_video;
  bool as_seen = false, force = false;
};
struct ResumeVerb {
  std::filesystem::path dir;
  unsigned threads = 0;
};
struct LabVerb {
  std::filesystem::path scene, pages;
  int port = 0;
  unsigned threads = 0;
  bool no_browser = false;
};
struct DropVerb {
  std::filesystem::path picture, overlay, stages;
  bool force = false;
};
struct TrackVerb {
  std::filesystem::path video, swarm, overlay, report, picture, figures;
  std::vector<std::filesystem::path> out;
  std::string scale;  ///< a number or a calibration file
  std::string polarity = "auto", background = "auto", motion = "auto";
  double fps = 0, size_px = 0, threshold = 0, reach_px = 0;
  int memory = 2, least = 3, interval = 0;
  bool drop = false, force = false;
};
struct ScaleVerb {
  std::filesystem::path ruler, out, overlay;
  std::string tick;
  bool force = false;
};
struct FieldVerb {
  std::filesystem::path rig, points, measured;
  std::string at = "0 mm, 0 mm", polarity = "north", size = "6 mm, 4.5 mm", current, view, drop;
  std::filesystem::path picture, out;
  bool check = false, force = false;
};
struct LibraryVerb {
  std::filesystem::path rig, out;
  std::string size = "2 mm, 2 mm", spacing;
  int levels = 0;
  unsigned threads = 0;
  bool force = false;
};
/// How flows are made: the flow part, the parameters given for it in words, and what comes before and beside
/// it.
struct FlowOptions {
  std::string method = "horn_schunck";
  std::vector<std::pair<std::string, std::string>> values;
  int shrink = 0;
  double fps = 0;
  unsigned threads = 0;
};
/// What counts as a response.
struct ResponseOptions {
  std::optional<double> direction, flow_threshold;
};
struct FlowVerb {
  std::filesystem::path a, b, out, picture, truth, overlay;
  FlowOptions flow;
  bool force = false;
};
struct ActivityVerb {
  std::optional<double> from, to;
  std::vector<std::filesystem::path> videos;  ///< or one study file
  std::filesystem::path noise, out, report, picture;
  ResponseOptions response;
  FlowOptions flow;
  bool force = false;
};
struct CompareVerb {
  std::filesystem::path reference, out, report;
  std::vector<std::filesystem::path> runs;
  ResponseOptions response;
  std::optional<double> reference_t0, t0, duration;
  double m = 0.9, threshold = 3;
  bool no_align = false, no_floor = false;
  FlowOptions flow;
  bool force = false;
};
struct DistanceVerb {
  std::filesystem::path p, similarity;
  std::vector<std::filesystem::path> q;
  double m = 0.9, threshold = 3;
  bool normalise = false;
};
/// A study of many simulations, in a directory of its own.
struct StudyVerb {
  std::filesystem::path study, out;
  std::string shard;  ///< "3/16"
  std::vector<std::filesystem::path> merge;
  unsigned threads = 0;
  bool force = false;
};
/// What `faba rig ...` takes.
struct RigVerb {
  RunVerb run;
  std::filesystem::path at, log;
  std::string step = "50 mA";
  std::optional<std::string> exposure, repeat, every, time;
  std::string format;
  std::uint64_t frames = 0, one_of = 1;
  bool buffered = false;
  std::string experiment;
  bool arm = false, once = false;
};
struct PartsVerb {
  std::string kind, name;
};

/// The program as it was called, for commands that a user is told to type.
const std::string& program();
/// A line on standard error; lost when nobody can be told.
void tell(const std::string& line);
/// A word as a shell takes it for one: in quotes where it needs them.
std::string shell_word(const std::string& word);

// Each returns the exit code; errors are thrown.
int run(const RunVerb& v, const Common& c);
int resume(const ResumeVerb& v, const Common& c);
int lab(const LabVerb& v, const Common& c);
int drop(const DropVerb& v, const Common& c);
int flow(const FlowVerb& v, const Common& c);
int activity(const ActivityVerb& v, const Common& c);
int compare(const CompareVerb& v, const Common& c);
int distance(const DistanceVerb& v, const Common& c);
int scale(const ScaleVerb& v, const Common& c);
int track(const TrackVerb& v, const Common& c);
int field_at(const FieldVerb& v, const Common& c);
int field_map(const FieldVerb& v, const Common& c);
int field_library(const LibraryVerb& v, const Common& c);
int field_fit(const FieldVerb& v, const Common& c);
int field_tolerance(const FieldVerb& v, const Common& c);
int field_null(const FieldVerb& v, const Common& c);
int identify(const StudyVerb& v, const Common& c);
int compare_controllers(const StudyVerb& v, const Common& c);
int rig_capture(const RigVerb& v, const Common& c);
int rig_step_response(const RigVerb& v, const Common& c);
int rig_run(const RigVerb& v, const Common& c);
int rig_simulate(const RigVerb& v, const Common& c);
int rig_list(const Common& c);
int rig_check(const RigVerb& v, const Common& c);
int rig_jog(const RigVerb& v, const Common& c);
int rig_replay(const RigVerb& v, const Common& c);
int parts(const PartsVerb& v, const Common& c);
int schema(const std::string& file, const Common& c);
int doctor(const Common& c);

/// Becomes true on Ctrl-C and SIGTERM; the second Ctrl-C ends the program at once. Only who asks has to look
/// at it: a program that never does is ended by the first signal.
const std::atomic<bool>& stop_requested();

}  // namespace faba::cli
