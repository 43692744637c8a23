#include "app/bench/step_response.h"
#include "app/scenario/read_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "app/bench/bench_session.h"
#include "core/file.h"
#include "core/monotonic.h"
#include "core/portable_math.h"
#include "core/threads/urgent.h"
#include "core/units.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr const char* kStudy = "study.toml";
constexpr double kCurrentRounding = 1e-9;  // relative rounding error of a current
constexpr double kWaitPeriod = 0.05;       // s between checks of the clock while waiting

Json field_json_text(Vec2 b) { return {fmt::format("{} T", b.x), fmt::format("{} T", b.y)}; }

// The scenario with a manual field in place of its controller: `gather` drives the cells to one side,
// `respond` reverses the field after `before`.
struct Scenes {
  Scenario gather, respond;
};
Scenes scenes_of(Document d) {
  d.set("camera.sensor", Json("frames"), "step-response");
  for (const char* key : {"reference", "controller", "event"}) d.root.erase(key);
  if (!d.root.contains("estimator")) d.set("estimator", Json("image"), "step-response");
  const Scenario s = read_scenario(d, builtin_parts());
  if (!s.rig) throw Error(Errc::usage, "rig", "the table [rig] is missing; add it, as in scenes/bench.toml");
  const StepResponseParams& p = s.rig->step_response;
  const auto direction = portable::sincos(p.direction * kDegree);
  // Angles in pictures are clockwise, the world's y is up; south-seeking cells swim against the field.
  const Vec2 field = (s.polarity() * p.field) * Vec2{direction.cos, -direction.sin};
  const Json forward = {{"type", "manual"}, {"field", field_json_text(field)}};
  Json reversed = forward;
  reversed["segment"] =
      Json::array({{{"at", fmt::format("{} s", p.before)}, {"field", field_json_text(-1.0 * field)}}});
  d.set("controller", forward, "step-response");
  d.set("duration", Json(fmt::format("{} s", p.gather)), "step-response");
  const Scenario gather = read_scenario(d, builtin_parts());
  d.set("controller", reversed, "step-response");
  d.set("duration", Json(fmt::format("{} s", p.before + p.record)), "step-response");
  d.set("record.lossless", Json(true), "step-response");
  return {gather, read_scenario(d, builtin_parts())};
}

// Coils at their current limit would give another field, in another direction.
void check_field(const Scenario& s, bool is_default) {
  const BenchControls c(s);
  const double field = s.rig->step_response.field;
  const Command command = c.controller->update({}, {}, s.frame_period());
  const std::vector<double> common = c.field->max_currents(s.limits.max_current),
                            wired = s.rig->max_current();
  double fraction = 1;
  for (std::size_t k = 0; k < command.current.size(); ++k)
    if (const double i = std::fabs(command.current[k]); i > 0)
      fraction = std::min(fraction, std::min(common[k], wired[k]) / i);
  if (fraction < 1 - kCurrentRounding)
    throw Error(
        Errc::usage, "rig.step_response.field",
        fmt::format(
            "{:.1f} uT{} is out of range; the maximum at the current limits of the coils is {:.1f} uT{}",
            1e6 * field, is_default ? " (the default)" : "", 1e6 * fraction * field,
            is_default ? "; set rig.step_response.field" : ""));
}

// The study file; existing entries are kept.
class StudyFile {
 public:
  StudyFile(const std::filesystem::path& dir, const StepResponseParams& p, std::string experiment)
      : path_(dir / kStudy), experiment_(std::move(experiment)) {
    std::error_code ec;
    if (std::filesystem::exists(path_, ec)) root_ = read_toml(path_).root;
    if (!root_.contains("video")) root_["video"] = Json::array();
    const Json& videos = root_["video"];
    if (!videos.is_array() ||
        !std::all_of(videos.begin(), videos.end(), [](const Json& v) { return v.is_object(); }))
      throw Error(Errc::usage, path_.string() + ": video",
                  "must be an array of tables [[video]]; choose another --out");
    if (experiment_.empty()) {
      std::vector<std::string> names;
      for (const Json& v : root_["video"])
        names.push_back(v.contains("experiment") ? v["experiment"].dump() : "");
      std::sort(names.begin(), names.end());
      experiment_ = std::to_string(std::unique(names.begin(), names.end()) - names.begin() + 1);
    }
    direction_ = std::fmod(p.direction + 180, 360);
  }
  const std::string& experiment() const { return experiment_; }
  void add(const RecordedResponse& r) {
    root_["video"].push_back({{"file", r.dir.filename().string()},
                              {"exposure", fmt::format("{:.1f} s", r.exposure)},
                              {"experiment", experiment_},
                              {"direction", direction_},
                              {"from", fmt::format("{:.4g} s", r.reversal)}});
    write_file(path_, to_toml(root_));
  }

 private:
  std::filesystem::path path_;
  std::string experiment_;
  Json root_ = Json::object();
  double direction_ = 0;  ///< deg
};

// A schedule in real time that can be stopped.
class Schedule {
 public:
  Schedule(const StepResponseJob& job, const StepResponseParams& p)
      : job_(job),
        began_(monotonic_now()),
        total_(p.every * (p.repeat - 1) + p.gather + p.before + p.record) {}
  double now() const { return monotonic_now() - began_; }
  bool stopped() const { return job_.run.stop && job_.run.stop->load(); }
  bool keep_running() const {
    if (job_.run.progress)
      job_.run.progress(std::uint64_t(1e3 * std::min(now(), total_)), std::uint64_t(1e3 * total_));
    return !stopped();
  }
  void wait_until(double t) const {
    while (now() < t && keep_running())
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(kWaitPeriod, t - now())));
  }

 private:
  const StepResponseJob& job_;
  double began_, total_;  ///< s
};

// Drives the cells to one side and measures the position of the swarm.
void gather(OpenBench& bench, const Scenario& s, const Schedule& schedule, RecordedResponse& out) {
  BenchControls controls(s);
  BenchRig& rig = bench.rig({});
  rig.begin();
  Loop loop = controls.loop(rig, s.frame_period());
  struct Newest final : Sink {
    void take(const Tick& t) override { estimate = t.estimate; }
    Estimate estimate;
  } newest;
  loop.sinks = {&newest};
  if (Sink* shown = bench.shown()) loop.sinks.push_back(shown);
  const Urgent urgent;
  run(loop, std::numeric_limits<std::uint64_t>::max(), [&] {
    if (loop.next == 1) rig.arm();
    return loop.last_t + 0.5 * loop.frame_period < s.params.duration && schedule.keep_running();
  });
  out.cells = newest.estimate.visible;
  if (out.cells > 0) out.at_px = controls.frame.image_from_world(newest.estimate.centroid);
}

// Time in the video of a run of what happened `t` s after its start. The frames of the video have equal
// distances, also where the camera dropped some.
double time_in_video(const BenchSession& session, double t) {
  const Table series = session.series();
  const auto times = series.column("t_s");
  const auto before = std::count_if(times.begin(), times.end(), [t](double at) { return at < t; });
  const double rate = VideoReader(session.dir() / "video.avi").fps();
  return rate > 0 ? double(before) / rate : t;
}

}  // namespace

void check_step_response(const Document& scene) {
  const Json::json_pointer field_key("/rig/step_response/field");
  check_field(scenes_of(scene).gather, !scene.root.contains(field_key));
}

std::string schedule_note(const StepResponseParams& p) {
  const double one = p.gather + p.before + p.record;
  if (p.repeat < 2 || p.every == 0 || p.every >= one) return "";
  return fmt::format(
      "rig.step_response.every (--every): {:g} s is shorter than one response (about {:.3g} s); responses "
      "follow each other immediately",
      p.every, one);
}

std::vector<RecordedResponse> record_step_responses(const StepResponseJob& job) {
  if (job.experiment.find('/') != std::string::npos || job.experiment.starts_with('.'))
    throw Error(Errc::usage, "--experiment",
                fmt::format("\"{}\" is not a valid file name; it must not contain / or start with a dot",
                            job.experiment));
  Scenes scenes = scenes_of(job.scene);
  const StepResponseParams p = scenes.gather.rig->step_response;
  const Json::json_pointer field_key("/rig/step_response/field");
  check_field(scenes.gather, !job.scene.root.contains(field_key));
  std::error_code ec;
  if (std::filesystem::exists(job.run.out / run_files::kScenario, ec))
    throw Error(Errc::usage, job.run.out.string(), "is the directory of a run; choose another --out");
  StudyFile study(job.run.out, p, job.experiment);
  OpenBench bench(scenes.gather, job.seed, OpenBench::Open::all, job.devices);
  scenes.respond.camera.rate = scenes.gather.camera.rate;
  bench.try_coils();
  std::filesystem::create_directories(job.run.out, ec);
  if (ec) throw Error(Errc::usage, job.run.out.string(), "cannot be created: " + ec.message());
  bench.rig(job.run.out / fmt::format("coils-{}.log", study.experiment()));
  scenes.gather.rig->params.delay = scenes.respond.rig->params.delay =
      scenes.gather.rig->params.delay.value_or(0);  // delays do not matter for a schedule

  std::vector<RecordedResponse> all;
  const Schedule schedule(job, p);
  const auto check = [&] {
    if (schedule.stopped())
      throw Error(Errc::interrupted, job.run.out.string(),
                  fmt::format("interrupted after {} of {} step responses", all.size(), p.repeat));
  };
  for (int i = 0; i < p.repeat; ++i) {
    schedule.wait_until(i * p.every);
    check();
    RecordedResponse response;
    gather(bench, scenes.gather, schedule, response);
    check();
    Scenario s = scenes.respond;
    response.exposure = s.params.exposure = scenes.gather.params.exposure + schedule.now();
    RunOptions o = job.run;
    o.out /= fmt::format("{}-{:.0f}s", study.experiment(), response.exposure);
    o.numbered = true;
    o.progress = [&](std::uint64_t, std::uint64_t) { (void)schedule.keep_running(); };
    BenchSession session =
        BenchSession::begin(s, std::shared_ptr<OpenBench>(&bench, [](OpenBench*) {}), job.seed, o);
    response.dir = session.dir();
    if (!session.run()) check();
    response.frames = session.manifest().frames;
    response.dropped = session.manifest().bench->frames_dropped;
    response.reversal = time_in_video(session, p.before);
    if (job.done) job.done(response);
    session.complete();
    study.add(response);
    all.push_back(response);
  }
  return all;
}

}  // namespace faba
