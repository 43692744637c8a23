#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "app/scenario/calibration_file.h"
#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "cli/verbs/track/track_verb.h"
#include "core/counted.h"
#include "core/error.h"
#include "core/file.h"
#include "study/data/run_video.h"
#include "study/pages/provenance_output.h"
#include "study/pages/tracks/preview_output.h"
#include "study/pages/tracks/track_folder.h"
#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_output.h"
#include "study/pages/tracks/track_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

template <class Enum>
Enum chosen(const std::string& word, const std::vector<const char*>& words) {
  return Enum(std::find(words.begin(), words.end(), word) - words.begin());
}

// Formats numbers with their standard errors: in um if there is a scale, per frame if times are frame
// numbers.
class TrackUnits {
 public:
  explicit TrackUnits(const TrackMeasurement& m) : um_per_px_(m.um_per_px.value_or(0)), timed_(m.timed) {}
  std::string velocity(const Estimated& e) const { return estimate(e, scale(), length() + per_time()); }
  std::string diffusion(const Estimated& e) const {
    return estimate(e, scale() * scale(), length() + "^2" + per_time());
  }
  std::string speed_range(const SpeedPopulation& p) const {
    return fmt::format("{:.3g} {}{} (90 % interval {:.3g} to {:.3g})", scale() * p.speed_px_s, length(),
                       per_time(), scale() * p.ci90[0], scale() * p.ci90[1]);
  }
  std::string time(const Estimated& e) const { return estimate(e, 1, timed_ ? "s" : "frames"); }
  std::string duration(double time) const {
    return fmt::format("{:.3g} {}", time, timed_ ? "s" : time == 1 ? "frame" : "frames");
  }

 private:
  double scale() const { return um_per_px_ > 0 ? um_per_px_ : 1; }
  std::string length() const { return um_per_px_ > 0 ? "um" : "px"; }
  const char* per_time() const { return timed_ ? "/s" : "/frame"; }
  static std::string estimate(const Estimated& e, double scale, const std::string& unit) {
    if (!std::isfinite(scale * e.value)) return "-";
    return with_uncertainty(scale * e.value, scale * e.se) + " " + unit;
  }
  double um_per_px_;
  bool timed_;
};

std::string given(bool is_given) { return is_given ? "given" : "estimated"; }

// The options that determine the result, as they could be given.
void print_options(const TrackDetection& d) {
  fmt::print("options  --size {:.3g} ({}), --threshold {:.3g} ({}), --region {}", d.size_px,
             given(d.size_given), d.threshold_snr, given(d.threshold_given),
             d.region ? fmt::format("{},{},{},{} (given)", d.region->col, d.region->row, d.region->width,
                                    d.region->height)
                      : "not given");
}

void print_summary(const TrackMeasurement& m) {
  const TrackSummary& s = m.summary;
  const TrackUnits units(m);
  fmt::print("spots    {:.4g} per frame, {}, {:.2g} px wide, background: {}\n", m.detection.spots_per_frame,
             word_of(m.detection.polarity), m.detection.size_px, background_word(m.detection));
  print_options(m.detection);
  fmt::print(", --least {}, --reach {:.3g}\n", m.joining.min_points, m.joining.search_radius_px);
  const ScoreSummary score = summary_of(m.scores);
  fmt::print("tracks   {} in {}, {:.3g} positions each{}\n", s.tracks,
             counted(std::uint64_t(m.frames), "frame"), s.mean_points,
             score.mean ? fmt::format(", mean score {:.2f}", *score.mean) : "");
  if (quality_of(m.warnings) == Quality::poor) {
    fmt::print(
        "         speeds and motion are not stated, because the quality is poor; --json gives all values\n");
    return;
  }
  if (m.populations.size() > 1)
    for (const SpeedPopulation& p : m.populations)
      fmt::print("         {:.0f} % {}{}\n", 100 * p.fraction, word_of(p.motion),
                 p.motion == PopulationMotion::still ? "" : ", median speed " + units.speed_range(p));
  const bool drifts = s.speed_count > 0 && s.order > 0.5 && s.msd.size() > 0;
  const bool together = drifts || mean_order(s) > 0.5;
  const char* about = !together ? "" : drifts ? "relative to the drift: " : "relative to the common motion: ";
  const SupportedWalk walk = misfit_of(s).significant ? SupportedWalk::none : supported_walk(s);
  if (s.speed_count > 0 && one_population(m) && (together || walk != SupportedWalk::diffusion))
    fmt::print("speed    mean {} (+- standard error; displacements over {})\n",
               units.velocity(s.mean_speed_px_s), units.duration(s.interval_s));
  if (drifts)
    fmt::print("drift    {} right, {} down\n", units.velocity(s.drift_x_px_s),
               units.velocity(s.drift_y_px_s));
  if (walk == SupportedWalk::diffusion && s.diffusion.good)
    fmt::print("motion   {}diffusion, D = {} (standard error)\n", about, units.diffusion(s.d_px2_s));
  if (walk == SupportedWalk::persistent && s.persistent.good)
    fmt::print("motion   {}persistent walk, {}persistence time {}\n", about,
               one_population(m) ? fmt::format("speed {} (rms), ", units.velocity(s.speed_rms_px_s)) : "",
               s.persistent.tau_open ? "longer than the observed time" : units.time(s.tau_s));
}

int preview(const TrackVerb& v, const Common& c) {
  const auto& stop = stop_requested();
  Progress bar("preview", !c.quiet);
  const TrackPreview p =
      preview_video(options_of(v, v.videos.front()), v.preview, [&](std::int64_t done, std::int64_t total) {
        bar.update(std::uint64_t(done), std::uint64_t(total));
        return !stop;
      });
  bar.clear();
  if (c.json) {
    fmt::print("{}\n", preview_json(p).dump());
    return 0;
  }
  if (c.quiet) return 0;
  const TrackDetection& d = p.detection;
  fmt::print("spots    {:.4g} per frame in {}, {}, {:.2g} px wide, background: {}\n", d.spots_per_frame,
             counted(p.frames.size(), "frame"), word_of(d.polarity), d.size_px, background_word(d));
  print_options(d);
  fmt::print("\n");
  print_quality(p.warnings);
  fmt::print("wrote    {}\n", v.preview.string());
  return 0;
}

// The verb with the files of --result among its outputs, and their folder created.
TrackVerb with_result(const TrackVerb& asked) {
  TrackVerb v = asked;
  if (v.result.empty()) return v;
  check_output_folder(v.result, "--result");
  std::error_code ec;
  std::filesystem::create_directories(v.result, ec);
  if (ec) throw Error(Errc::usage, v.result.string(), "the folder cannot be created: " + ec.message());
  v.formats.clear();
  for (const TrackTable& table : tables_of(asked))
    v.formats.emplace_back(kTrackFormatWords[std::size_t(table.format)]);
  v.out.push_back(v.result / track_files::kTracks);
  v.formats.emplace_back("csv");
  if (v.per_track.empty()) v.per_track = v.result / track_files::kPerTrack;
  if (v.report.empty()) v.report = v.result / track_files::kReport;
  check_output(v.result / track_files::kSummary, {}, v.force, {});
  return v;
}

int track(const TrackVerb& asked, const Common& c) {
  if (!asked.edits.empty()) return apply_track_edits(asked, c);
  if (!asked.result.empty() && (asked.videos.size() > 1 || !asked.folder.empty()))
    throw Error(Errc::usage, "--result", "requires a single video; use --folder for several");
  const TrackVerb v = with_result(asked);
  if (v.videos.size() > 1 || !v.folder.empty()) return track_videos(v, c);
  if (!v.engine.engine.empty())
    throw Error(Errc::usage, "--engine",
                "requires several videos, or --folder: one video is computed by one worker");
  check_engine(v.engine);
  check_outputs(v, v.force, v.videos);
  expect_videos();
  if (!v.preview.empty()) return preview(v, c);
  const auto& stop = stop_requested();
  Progress bar("tracking", !c.quiet);
  TrackOptions options = options_of(v, v.videos.front());
  if (c.json || !v.report.empty()) options.provenance = provenance_of(c, v.videos);
  const TrackMeasurement tracks = track_video(options, [&](std::int64_t done, std::int64_t total) {
    bar.update(std::uint64_t(done), std::uint64_t(total));
    return !stop;
  });
  bar.clear();
  nlohmann::ordered_json summary = track_json(tracks);
  if (!asked.formats.empty()) summary["tables"] = tables_json(tables_of(asked), tracks.um_per_px);
  if (!v.result.empty()) {
    add_provenance(summary, options.provenance);
    write_file(v.result / track_files::kSummary, summary.dump() + "\n");
  }
  if (!c.quiet && !c.json)
    for (const std::string& note : tracks.notes) print_stderr("faba: note: " + note);
  if (c.json) {
    print_json(std::move(summary), options.provenance);
    return 0;
  }
  if (c.quiet) return 0;
  print_summary(tracks);
  print_quality(tracks.warnings);
  for (const TrackTable& table : options.out)
    fmt::print("wrote    {}{}\n", table.file.string(), table_remark(table, tracks.um_per_px));
  for (const auto* path : {&v.swarm, &v.overlay, &v.report, &v.picture, &v.per_track, &v.figures})
    if (!path->empty()) fmt::print("wrote    {}\n", path->string());
  return 0;
}

}  // namespace

std::vector<TrackTable> tables_of(const TrackVerb& v) {
  if (v.out.empty() && !v.formats.empty())
    throw Error(Errc::usage, "--format", "requires --out, the file for the tracks, such as --out tracks.csv");
  if (v.formats.size() > 1 && v.formats.size() != v.out.size())
    throw Error(Errc::usage, "--format",
                fmt::format("{} formats are given for {}; give one format for all, or one for each --out",
                            v.formats.size(), counted(v.out.size(), "file")));
  std::vector<TrackTable> tables;
  for (std::size_t i = 0; i < v.out.size(); ++i) {
    tables.push_back({v.out[i], TrackFormat::automatic});
    if (v.formats.empty()) continue;
    const std::string& word = v.formats.size() == 1 ? v.formats.front() : v.formats[i];
    tables.back().format =
        TrackFormat(std::find(std::begin(kTrackFormatWords), std::end(kTrackFormatWords), word) -
                    std::begin(kTrackFormatWords));
  }
  return tables;
}

std::vector<std::string> extensions_of(TrackFormat format) {
  if (format == TrackFormat::automatic) return {".csv", ".h5"};
  return {format == TrackFormat::hdf5 ? ".h5" : ".csv"};
}

TrackOptions options_of(const TrackVerb& v, const std::filesystem::path& video) {
  TrackOptions o;
  o.video = video;
  o.part = v.part.part(v.fps);
  o.threads = v.threads;
  o.out = tables_of(v);
  if (!v.scale.empty()) {
    const Calibration c = parse_calibration(v.scale, "--um-per-px");
    o.scale = {c.um_per_px, c.typed() ? "typed" : "calibration", ""};
  }
  o.swarm = v.swarm;
  o.overlay = v.overlay;
  o.report = v.report;
  o.picture = v.picture;
  o.figures = v.figures;
  o.size_px = v.size_px;
  o.threshold_sd = v.threshold;
  o.inside_drop = v.drop;
  o.keep_drift = v.keep_drift;
  o.per_track = v.per_track;
  if (!v.region.empty()) o.region = PixelRegion{v.region[0], v.region[1], v.region[2], v.region[3]};
  o.interval_frames = v.interval;
  o.polarity = chosen<Polarity>(v.polarity, {"auto", "dark", "bright", "both"});
  o.background = chosen<BackgroundKind>(v.background, {"auto", "median", "spatial"});
  o.tracker.motion = chosen<Motion>(v.motion, {"auto", "nearest", "velocity"});
  o.tracker.search_radius_px = v.search_radius_px;
  o.tracker.max_gap_frames = v.max_gap_frames;
  o.tracker.min_points = v.min_points;
  return o;
}

void check_outputs(const TrackVerb& v, bool force, const std::vector<std::filesystem::path>& inputs) {
  for (const TrackTable& table : tables_of(v))
    check_output(table.file, extensions_of(table.format), force, inputs);
  std::vector<std::filesystem::path> all = v.out;
  all.insert(all.end(), {v.swarm, v.overlay, v.report, v.picture, v.per_track, v.preview});
  check_distinct(std::move(all));
  check_output(v.swarm, {".csv"}, force, inputs);
  check_output(v.overlay, {".mp4", ".avi"}, force, inputs);
  check_output(v.report, {".html"}, force, inputs);
  check_output(v.picture, {".png"}, force, inputs);
  check_output(v.preview, {".png"}, force, inputs);
  check_output(v.per_track, {".csv"}, force, inputs);
  check_output_folder(v.figures, "--figures");
  if (!v.figures.empty() && std::filesystem::is_directory(v.figures))
    for (const char* name : {"tracks.svg", "speeds.svg", "msd.svg", "heading.svg"})
      check_output(v.figures / name, {".svg"}, force, inputs);
}

void add_track_options(CLI::App* v, TrackVerb& t) {
  v->add_option(
       "videos", t.videos,
       "Video, TIFF stack, folder of pictures, quoted file name pattern, or run directory; several give "
       "a folder of results each, see --folder")
      ->required();
  v->add_option("--fps", t.fps,
                "Frames per second, if the video states none or a wrong value; default: that of the video")
      ->check(between(1e-6, 1e7));
  add_part_options(v, t.part);
  add_threads_option(v, t.threads);
  v->add_option("--um-per-px", t.scale,
                "Scale: micrometres per pixel, or a calibration file from `faba scale`; default: that of a "
                "run directory, else results in px")
      ->check(not_empty);
  v->add_option("--out", t.out, "Write the tracks, as CSV or HDF5 by the file extension; may be given twice");
  v->add_option(
       "--format", t.formats,
       "Format of --out: csv, hdf5, trackmate or napari (CSV files for these programs); default: csv or "
       "hdf5 by the file extension; once, or once for each --out")
      ->take_all()
      ->allow_extra_args(false)
      ->check(one_of({"csv", "hdf5", "trackmate", "napari"}));
  v->add_option(
       "--folder", t.folder,
       "Several videos: directory of the results; default: runs/tracks. Each video has a folder in it, "
       "and outputs are names of files in this folder. An incomplete directory is resumed")
      ->check(not_empty);
  v->add_option("--result", t.result,
                "Write tracks.csv, per_track.csv, tracks.html and track.json into this folder: the result "
                "that --edits and the page of `faba lab` read")
      ->check(not_empty);
  v->add_option(
       "--edits", t.edits,
       "Do not track: apply the cuts and changes of this file to a folder that --result has written, "
       "and write the tracks that are used to --out, their features to --per-track")
      ->check(not_empty);
  v->add_option("--swarm", t.swarm, "Write centroid and covariance of the swarm in each frame, as CSV");
  v->add_option("--overlay", t.overlay, "Write the video with the tracks, as MP4 or AVI");
  v->add_option("--report", t.report, "Write a page with all figures, as HTML");
  v->add_option("--picture", t.picture, "Write the first frame with all tracks, as PNG");
  v->add_option("--per-track", t.per_track, "Write a row with length and quality of each track, as CSV");
  v->add_option("--figures", t.figures, "Write the figures into this folder, as SVG");
  CLI::Option* preview =
      v->add_option("--preview", t.preview,
                    "Detect the cells in some frames only, write these frames as PNG, and do not track");
  for (const char* other :
       {"--out", "--result", "--swarm", "--overlay", "--report", "--picture", "--per-track", "--figures"})
    preview->excludes(other);
  v->add_option("--size", t.size_px, "Full width of a cell at half its contrast, px; default: measured")
      ->check(between(1, 60));
  v->add_option("--polarity", t.polarity, "Cells are dark, bright or both; default: auto, measured")
      ->check(one_of({"auto", "dark", "bright", "both"}));
  v->add_option("--background", t.background,
                "Background: median of the video, or spatial (each frame, smoothed); default: auto, chosen "
                "for the video")
      ->check(one_of({"auto", "median", "spatial"}));
  v->add_option(
       "--threshold", t.threshold,
       "Minimum signal-to-noise ratio of a spot; default: the value that gives one false detection in "
       "10 frames")
      ->check(between(1, 1e6));
  v->add_option("--reach", t.search_radius_px,
                "Maximum displacement between two frames, px; default: measured")
      ->check(between(0.1, 1e5));
  v->add_option("--motion", t.motion,
                "Predict positions by velocity, or use the nearest spot; default: auto, chosen for the video")
      ->check(one_of({"auto", "nearest", "velocity"}));
  v->add_option(
       "--memory", t.max_gap_frames,
       fmt::format("Maximum number of consecutive frames without a detection of the cell; default: {}",
                   t.max_gap_frames))
      ->check(integers(0, 1000));
  v->add_option("--least", t.min_points,
                fmt::format("Minimum number of detections of a track; default: {}", t.min_points))
      ->check(integers(1, 100000));
  v->add_option(
       "--interval", t.interval,
       "Number of frames over which displacements are measured for speeds and turns; default: measured")
      ->check(integers(1, 100000));
  v->add_option(
       "--region", t.region,
       "Search this part of the frames only: column and row of its corner at the top left, width and "
       "height, px; default: all")
      ->delimiter(',')
      ->expected(4);
  v->add_flag("--keep-drift", t.keep_drift,
              "Do not subtract the motion of the stage from speeds and displacements; default: subtracted "
              "where objects fixed to the stage show it");
  v->add_flag("--drop", t.drop, "Detect the edge of the drop in the first frame and search inside it only");
  v->add_flag("--force", t.force,
              "Replace existing files; several videos: replace other results in the directory");
  add_engine_options(v, t.engine);
}

void add_track(CLI::App& app, CommandLine& line) {
  const auto t = std::make_shared<TrackVerb>();
  CLI::App* v =
      verb(app, line, "track", "Detect and track cells or beads in videos and measure how they move",
           "  faba track film.avi --um-per-px 0.35 --out tracks.csv --report tracks.html\n"
           "  faba track 'frames/frame_*.tif' --fps 26.87 --out tracks.h5 --overlay seen.mp4\n"
           "  faba track film.avi --out spots.csv --format trackmate\n"
           "  faba track film.avi --result runs/film\n"
           "  faba track runs/film --edits runs/film/edits.toml --out fast.csv\n"
           "  faba track films/*.avi --folder runs/films --out tracks.csv --engine local");
  add_track_options(v, *t);
  v->callback([t, &line] { line.code = track(*t, line.common); });
}

}  // namespace faba::cli
