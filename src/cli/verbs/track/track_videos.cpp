// Tracking of several videos: a study whose tasks are videos.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/options/study.h"
#include "cli/options/video_inputs.h"
#include "cli/options/words.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/verbs/track/track_verb.h"
#include "core/counted.h"
#include "core/error.h"
#include "core/file.h"
#include "study/data/run_video.h"
#include "study/pages/provenance_output.h"
#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_output.h"
#include "study/pages/tracks/track_report.h"

namespace faba::cli {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

// Names of the folders of videos: their names without extension, each once.
std::vector<std::string> folder_names(const std::vector<fs::path>& videos) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (const fs::path& video : videos) {
    const fs::path named = video.has_filename() ? video : video.parent_path();
    std::string name = named.stem().string();
    for (char& ch : name)
      if (std::string_view("*?[]/\\ ").find(ch) != std::string_view::npos) ch = '_';
    std::string unique = name.empty() || name.front() == '.' ? "video" : name;
    for (int k = 2; !used.insert(unique).second; ++k) unique = fmt::format("{}-{}", name, k);
    names.push_back(unique);
  }
  return names;
}

void check_names(const TrackVerb& v) {
  if (!v.preview.empty()) throw Error(Errc::usage, "--preview", "requires a single video");
  std::vector<fs::path> names = v.out;
  names.insert(names.end(), {v.swarm, v.overlay, v.report, v.picture, v.per_track, v.figures});
  for (const fs::path& name : names) {
    if (name.has_parent_path())
      throw Error(
          Errc::usage, name.string(),
          fmt::format("must be a name without a folder, such as {}: with several videos it is written "
                      "to the folder of each video",
                      name.filename().string()));
    if (name == "track.json")
      throw Error(Errc::usage, name.string(), "is the name of a file that is always written; give another");
  }
  check_outputs(v, true, {});
}

class TrackVideosJob final : public StudyJob {
 public:
  explicit TrackVideosJob(StudySource source) : source_(std::move(source)) {
    CLI::App app;
    add_track_options(&app, verb_);
    parse_words(app, source_.options, "faba track");
    check_names(verb_);
    options_ = options_with_effect({.verb = &app});
    names_ = folder_names(verb_.videos);
    std::vector<fs::path> files = verb_.videos;
    std::error_code ec;
    if (fs::is_regular_file(verb_.scale, ec)) files.emplace_back(verb_.scale);
    inputs_ = VideoInputs(source_, files);
  }
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return inputs_.hash; }
  std::string report() const override { return "tracks"; }
  std::vector<std::string> value_names() const override {
    return {"frames", "tracks", "mean_speed_px_per_s", "quality"};
  }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("tracking", !c.quiet && !c.json);
    options.progress = [&bar](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
    try {
      if (!sweep(dir.results(), videos_in(dir.path()), options)) return false;
    } catch (const Error& e) {
      bar.clear();
      if (e.code() != Errc::interrupted)
        write_file(dir.path() / "tracks.json", overview(dir.path()).dump(2) + "\n");
      throw;
    }
    bar.clear();
    for (std::size_t i = 0; i < names_.size(); ++i)  // of results that were computed in another directory
      if (!fs::exists(folder(dir.path(), i) / "track.json")) track(dir.path(), i);
    for (const auto& entry : fs::directory_iterator(dir.path() / study_files::kVideos))
      if (entry.path().filename().string().front() == '.') fs::remove_all(entry);  // of killed attempts
    overview_ = overview(dir.path());
    Provenance provenance;
    provenance.options = options_;
    provenance.inputs = inputs_.inputs;
    finish(dir, report(), overview_, provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (c.json || c.quiet) return;
    std::map<std::string, int> qualities;
    for (const OrderedJson& one : overview_["videos"]) ++qualities[one.value("quality", "")];
    fmt::print(
        "tracked {}; quality: {} good, {} doubtful, {} poor\nwrote   {}, and a folder for each video\n",
        counted(std::uint64_t(names_.size()), "video"), qualities["good"], qualities["doubtful"],
        qualities["poor"], (dir.path() / "tracks.json").string());
  }

  Round round(const fs::path& measured, const std::string&) const override {
    return videos_in(measured.parent_path());
  }

 private:
  static fs::path folder(const fs::path& dir, const std::string& name) {
    return dir / study_files::kVideos / name;
  }
  fs::path folder(const fs::path& dir, std::size_t i) const { return folder(dir, names_[i]); }

  Round videos_in(const fs::path& dir) const {
    Round r;
    r.description = "track videos";
    r.size = verb_.videos.size();
    r.work = [this, dir](std::uint64_t i) { return track(dir, i); };
    r.labels = [this](std::uint64_t i) {
      return std::vector<TaskLabel>{{"video", verb_.videos[i].string()}};
    };
    return r;
  }

  // Tracks a video with one thread, and renames the folder of the results when it is complete: another
  // attempt can do the same at the same time.
  std::vector<double> track(const fs::path& dir, std::size_t i) const {
    const fs::path& video = verb_.videos[i];
    inputs_.check(video);
    char host[64] = "";
    gethostname(host, sizeof host - 1);
    const fs::path temporary =
        dir / study_files::kVideos / fmt::format(".{}-{}-{}", names_[i], host, getpid());
    fs::create_directories(temporary);
    try {
      const TrackMeasurement m = track_into(temporary, i);
      std::error_code ec;
      fs::rename(temporary, folder(dir, i), ec);
      if (ec) fs::remove_all(temporary, ec);  // another attempt was first; its files are equal
      return {double(m.frames), double(m.summary.tracks), m.summary.mean_speed_px_s.value,
              double(quality_of(m.warnings))};
    } catch (...) {
      std::error_code ignored;
      fs::remove_all(temporary, ignored);
      throw;
    }
  }

  TrackMeasurement track_into(const fs::path& to, std::size_t i) const {
    TrackOptions o = options_of(verb_, verb_.videos[i]);
    for (TrackTable& table : o.out) table.file = to / table.file;
    for (fs::path* path : {&o.swarm, &o.overlay, &o.report, &o.picture, &o.per_track, &o.figures})
      if (!path->empty()) *path = to / *path;
    o.threads = 1;
    o.provenance.options = options_;
    o.provenance.inputs = {inputs_.of(verb_.videos[i])};
    const auto& stop = stop_requested();
    TrackMeasurement m = [&] {
      try {
        return track_video(o, [&](std::int64_t, std::int64_t) { return !stop; });
      } catch (const Error& e) {
        throw e.code() == Errc::interrupted ? study_stopped() : e;
      }
    }();
    OrderedJson j = track_json(m);
    if (!verb_.formats.empty()) j["tables"] = tables_json(tables_of(verb_), m.um_per_px);
    add_provenance(j, o.provenance);
    write_file(to / "track.json", j.dump() + "\n");
    return m;
  }

  // The main results of all videos that have some.
  OrderedJson overview(const fs::path& dir) const {
    OrderedJson all{{"videos", OrderedJson::array()}, {"without_result", OrderedJson::array()}};
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const fs::path file = folder(dir, i) / "track.json";
      if (!fs::exists(file)) {
        all["without_result"].push_back(verb_.videos[i].string());
        continue;
      }
      const OrderedJson one = OrderedJson::parse(read_file(file));
      OrderedJson entry{{"video", verb_.videos[i].string()},
                        {"folder", (fs::path(study_files::kVideos) / names_[i]).string()}};
      for (const char* key :
           {"quality", "frames", "duration_s", "um_per_px", "tracks", "populations", "warnings"})
        entry[key] = one.value(key, OrderedJson(nullptr));
      all["videos"].push_back(std::move(entry));
    }
    return all;
  }

  StudySource source_;
  TrackVerb verb_;
  std::vector<std::pair<std::string, std::string>> options_;
  std::vector<std::string> names_;
  VideoInputs inputs_;
  OrderedJson overview_;
};

}  // namespace

std::unique_ptr<StudyJob> track_job(const StudySource& source) {
  return std::make_unique<TrackVideosJob>(source);
}

int track_videos(const TrackVerb& v, const Common& c) {
  StudyOptions study;
  study.out = v.folder.empty() ? fs::path("runs") / "tracks" : v.folder;
  study.threads = v.threads;
  study.force = v.force;
  study.engine = v.engine;
  const SweepOptions options = sweep_options(study);
  check_names(v);
  expect_videos();
  TrackVideosJob job({"track", {}, {}, given_words(*c.verb, {"--folder"})});
  return run_study_verb(job, study, options, c);
}

}  // namespace faba::cli
