// `faba activity` by an engine: a study whose tasks are the stages of its videos.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/options/study.h"
#include "cli/options/video_inputs.h"
#include "cli/options/words.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/verbs/activity/activity_verb.h"
#include "core/error.h"
#include "core/file.h"
#include "core/statistics.h"
#include "study/motion/activity_archive.h"
#include "study/pages/activity_report.h"
#include "study/sweep/measured_file.h"

namespace faba::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kThresholds = "thresholds of videos";
constexpr const char* kMeasurement = "activity of videos, threshold ";

class ActivityStudyJob final : public StudyJob {
 public:
  explicit ActivityStudyJob(StudySource source) : source_(std::move(source)) {
    CLI::App app;
    ActivityVerb verb;
    add_activity_options(&app, verb);
    parse_words(app, source_.options, "faba activity");
    job_ = job_of(verb);
    job_.threads = 1;
    job_.stop = [&stop = stop_requested()] { return stop.load(); };
    provenance_.options = options_with_effect({.verb = &app});
    inputs_ = VideoInputs(source_, inputs_of(verb, job_));
    provenance_.inputs = inputs_.inputs;
  }
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return inputs_.hash; }
  std::string report() const override { return "activity"; }
  std::vector<std::string> value_names() const override {
    return {"threshold_px", "mean_activity", "responds", "peak_s"};
  }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("measuring", !c.quiet && !c.json);
    options.progress = [&bar](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
    std::vector<double> thresholds;
    if (const Round round = threshold_round(); round.size > 0) {
      if (!sweep(dir.results(), round, options)) return false;
      const std::uint64_t key = dir.results().key(round);
      for (std::uint64_t i = 0; i < round.size; ++i)
        thresholds.push_back(dir.results().find({key, i}).value()[0]);
    }
    const std::optional<double> threshold = common_threshold(job_, thresholds);
    if (!sweep(dir.results(), measurement_round(options.measured, threshold), options)) return false;
    bar.clear();
    std::vector<VideoActivity> videos;
    for (std::size_t i = 0; i < job_.videos.size(); ++i)
      videos.push_back(measured(options.measured, i, threshold));
    result_ = activity_result(std::move(videos), job_.group);
    write_file(dir.path() / "activity.csv", activity_csv(*result_));
    write_file(dir.path() / "activity.html", activity_page(*result_, provenance_));
    finish(dir, report(), activity_json(*result_), provenance_, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (c.json || c.quiet) return;
    print_activity(*result_);
    fmt::print("wrote {}\n", (dir.path() / "activity.html").string());
  }

  Round round(const fs::path& folder, const std::string& description) const override {
    if (description == kThresholds) return threshold_round();
    std::optional<double> threshold;
    if (const auto at = description.find("0x"); at != std::string::npos)
      threshold = std::strtod(description.c_str() + at, nullptr);
    return measurement_round(folder, threshold);
  }

 private:
  Round threshold_round() const {
    const auto videos = std::make_shared<const std::vector<ActivityInput>>(threshold_inputs(job_));
    Round r;
    r.description = kThresholds;
    r.size = videos->size();
    r.work = [this, videos](std::uint64_t i) {
      inputs_.check((*videos)[i].file);
      return std::vector<double>{threshold_of(job_, (*videos)[i])};
    };
    r.labels = [videos](std::uint64_t i) { return labels("threshold", (*videos)[i]); };
    return r;
  }

  // The results of a video are many numbers and texts: they are in a file in `folder`.
  Round measurement_round(const fs::path& folder, std::optional<double> threshold) const {
    Round r;
    r.description = kMeasurement + (threshold ? fmt::format("{:a}", *threshold) : "of the video");
    r.size = job_.videos.size();
    r.work = [this, folder, threshold](std::uint64_t i) {
      inputs_.check(job_.videos[i].file);
      VideoActivity a = measure_video(job_, i, threshold);
      Archive content;
      archive_activity(content, a);
      write_measured(folder, name_of(i), content);
      return std::vector<double>{a.threshold_px, a.mean_amount, double(a.responds),
                                 a.fit.good ? a.fit.peak_s : kNaN};
    };
    r.labels = [this](std::uint64_t i) { return labels("measurement", job_.videos[i]); };
    return r;
  }
  static std::vector<TaskLabel> labels(const char* stage, const ActivityInput& video) {
    return {{"stage", stage}, {"video", video.file.string()}};
  }
  std::string name_of(std::size_t i) const { return fmt::format("activity-{}-{}", inputs_.hash, i + 1); }

  // The video is measured here when another directory has its file.
  VideoActivity measured(const fs::path& folder, std::size_t i, std::optional<double> threshold) const {
    std::optional<Archive> content = read_measured(folder, name_of(i));
    if (!content) return measure_video(job_, i, threshold);
    VideoActivity a;
    archive_activity(*content, a);
    a.input = job_.videos[i];
    return a;
  }

  StudySource source_;
  ActivityJob job_;
  Provenance provenance_;
  VideoInputs inputs_;
  std::optional<ActivityResult> result_;
};

}  // namespace

std::unique_ptr<StudyJob> activity_job(const StudySource& source) {
  return std::make_unique<ActivityStudyJob>(source);
}

int activity_on_engine(const ActivityVerb& v, const Common& c) {
  if (!v.picture.empty())
    throw Error(Errc::usage, "--picture", "cannot be combined with --engine; measure this video without it");
  StudyOptions study;
  study.out = v.folder.empty() ? fs::path("runs") / "activity" : v.folder;
  study.threads = v.flow.threads;
  study.force = v.force;
  study.engine = v.engine;
  const SweepOptions options = sweep_options(study);
  ActivityStudyJob job({"activity", {}, {}, given_words(*c.verb, {"--folder", "--out", "--report"})});
  Common text = c;
  if (c.json) {  // its output is that of the command without an engine
    text.json = false;
    text.quiet = true;
  }
  const int code = run_study_verb(job, study, options, text);
  if (c.json)
    fmt::print("{}\n", nlohmann::ordered_json::parse(read_file(study.out / "activity.json")).dump());
  for (const auto& [to, name] : {std::pair{v.out, "activity.csv"}, std::pair{v.report, "activity.html"}})
    if (!to.empty()) {
      write_file(to, read_file(study.out / name));
      if (!c.json && !c.quiet) fmt::print("wrote {}\n", to.string());
    }
  return code;
}

}  // namespace faba::cli
