#include "server/jobs/job_estimate.h"

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/statistics.h"
#include "core/units.h"
#include "server/jobs/job_words.h"
#include "study/data/video_facts.h"
#include "study/experiment/experiment.h"
#include "study/identify/identify_study.h"
#include "study/steering/controller_study.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr double kMega = 1e6;
constexpr int kLongSide = 1024;         // larger frames are shrunk, see FlowSource::kLongSide
constexpr std::size_t kRemembered = 9;  // complete jobs of a kind that the estimate uses
// Simulations that are observed as positions have no pictures: equivalent size of a frame. Measured on two
// cores with 300 cells: 36 us of processor time per frame, and 18 ms per megapixel of rendered frames.
constexpr double kPositionsMegapixels = 0.002;
constexpr double kLeastPart = 0.2;  // of the time of a job that counts as in proportion to its work (assumed)
constexpr double kDefaultLevels = 100, kMostSets = 4e6;  // of `faba field library`

double megapixels(const VideoFacts& f) {
  const int side = std::max(f.width, f.height), shrink = (side + kLongSide - 1) / kLongSide;
  return double(f.width) * f.height / (shrink * shrink) / kMega;
}

double seconds_in(const Json& values, const char* key, double fallback) {
  if (!values.contains(key)) return fallback;
  const Json& v = values[key];
  if (v.is_number()) return v.get<double>();
  return v.is_string() && !v.get<std::string>().empty() ? parse_quantity(v.get<std::string>()).value
                                                        : fallback;
}

// Megapixels of the frames of a video between two times.
double video_work(const fs::path& file, double from_s, double to_s) {
  const VideoFacts f = video_facts(file);
  const double duration = f.duration_s();
  const double part = duration > 0 ? std::clamp((std::min(to_s, duration) - from_s) / duration, 0.0, 1.0) : 1;
  return double(std::max<std::int64_t>(f.frames, 1)) * megapixels(f) * part;
}

double videos_work(const JobKind& kind, const Json& values, const Workspace& workspace) {
  double work = 0;
  for (const JobInput& i : kind.inputs) {
    if (!values.contains(i.key)) continue;
    if (i.kind == JobInput::Kind::video)
      for (const std::string& file : files_of(i, values[i.key], workspace))
        work += video_work(workspace.existing(file), seconds_in(values, "from", 0),
                           seconds_in(values, "to", 1e9));
    if (i.kind == JobInput::Kind::experiment) {
      const fs::path file = workspace.existing(values[i.key].get<std::string>()) / kExperimentFile;
      for (const ExperimentVideo& v : read_experiment(file).videos)
        work += video_work(video_path(file, v), v.from_s.value_or(0), v.to_s.value_or(1e9));
    }
  }
  return work;
}

// Simulations start with the field reversal, or with the part of the video that is used.
double simulated_seconds(const ResponseInput& v, double duration_s) {
  const double end = std::min(v.part.to_s.value_or(duration_s), duration_s);
  if (!v.segments.empty()) return std::max(0.0, end - v.part.from_s);
  const double all = std::max(0.0, end - v.reversal_s.value_or(v.part.from_s));
  return std::min(all, v.duration_s.value_or(all));
}

double identify_work(const fs::path& file) {
  const IdentifyStudy study = read_identify_study(file);
  double frames = 0;
  for (const ResponseInput& v : study.videos) {
    const VideoFacts f = video_facts(v.file);
    frames += simulated_seconds(v, f.duration_s()) * f.fps *
              (study.look == Look::video ? megapixels(f) : kPositionsMegapixels);
  }
  double simulations = 0;
  for (const Candidate& c : study.candidates) simulations += c.simulations;
  return simulations * frames;
}

double controllers_work(const fs::path& file) {
  const ControllerStudy study = read_controller_study(file);
  const Scenario scene = read_scenario(study.scene, builtin_parts());
  double cells = 0;
  for (const Swarm& s : scene.swarms) cells += double(s.params.count);
  const double trials =
      double(study.controllers.size() * study.models.size() * std::max<std::size_t>(1, study.delays.size())) *
      study.seeds;
  return trials * double(scene.frames()) * cells / kMega;
}

double library_work(const Json& values, const Workspace& workspace) {
  const Document d = read_toml(workspace.existing(values.at("rig").get<std::string>()));
  const double coils = d.root.contains("coil") ? double(d.root["coil"].size()) : 1;
  const double levels = values.contains("levels") && values["levels"].is_number()
                            ? values["levels"].get<double>()
                            : std::min(kDefaultLevels, std::pow(kMostSets, 1 / coils));
  return std::pow(levels, coils) / kMega;
}

}  // namespace

double work_of(const JobKind& kind, const Json& values, const Workspace& workspace) {
  switch (kind.work) {
    case JobWork::fixed:
      return 0;
    case JobWork::pixels:
      return videos_work(kind, values, workspace);
    case JobWork::sets:
      return library_work(values, workspace);
    case JobWork::simulations:
    case JobWork::cell_frames:
      return work_of_study(kind, workspace.existing(values.at("study").get<std::string>()));
  }
  return 0;
}

double work_of_study(const JobKind& kind, const fs::path& study) {
  return kind.work == JobWork::simulations ? identify_work(study) : controllers_work(study);
}

JobEstimate estimate_job(const JobKind& kind, double work, const std::vector<Job>& jobs) {
  std::vector<double> rates;
  for (auto j = jobs.rbegin(); j != jobs.rend() && rates.size() < kRemembered; ++j) {
    if (j->kind != kind.name || j->state != Job::State::done) continue;
    if (kind.work == JobWork::fixed)
      rates.push_back(j->seconds);
    else if (j->work > 0)
      rates.push_back(std::max(kLeastPart * j->seconds, j->seconds - kind.fixed_s) / j->work);
  }
  if (rates.empty()) return {kind.fixed_s + work * kind.s_per_work, false};
  const double rate = median_high(rates);
  return {kind.work == JobWork::fixed ? rate : kind.fixed_s + work * rate, true};
}

}  // namespace faba
