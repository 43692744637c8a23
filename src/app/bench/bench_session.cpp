#include "app/bench/bench_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/bench/bench_controls.h"
#include "app/recording/manifest.h"
#include "app/recording/session.h"
#include "core/file.h"
#include "core/statistics.h"
#include "core/urgent.h"

namespace faba {
namespace {

constexpr double kDelaySteps = 1e4;  // of a second, to which a measured delay is written down

// Of the values that are known; null when there are none.
Json in_ms(std::vector<double> s) {
  std::erase_if(s, [](double x) { return std::isnan(x); });
  const auto ms = [&](double q) {
    const double v = 1e3 * quantile(s, q);
    return std::isnan(v) ? Json() : Json(v);
  };
  return {{"median", ms(0.5)}, {"p99", ms(0.99)}, {"p999", ms(0.999)}, {"max", ms(1)}};
}

}  // namespace

struct BenchSession::Impl {
  Scenario scenario;
  std::uint64_t seed;
  RunOptions options;
  std::unique_ptr<Pool> pool;
  std::unique_ptr<BenchControls> controls;
  std::shared_ptr<OpenBench> bench;
  BenchRig* rig = nullptr;  ///< of the bench
  RunDirectory directory;
  std::vector<std::unique_ptr<RunSink>> sinks;
  std::unique_ptr<Sink> commands;
  std::unique_ptr<Loop> loop;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  std::size_t most_behind = 0;
  std::uint64_t commands_before = 0, refused_before = 0,
                rests_before = 0;  ///< the bench may have had runs before
  bool whole = false;
  Json notes = Json::array();
  Json manifest;  ///< as it was when the run ended
};

BenchSession::BenchSession(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BenchSession::~BenchSession() = default;
BenchSession::BenchSession(BenchSession&&) noexcept = default;
const std::filesystem::path& BenchSession::dir() const { return impl_->directory.path(); }
void BenchSession::complete() { impl_->directory.complete(); }

BenchSession BenchSession::begin(Scenario s, std::shared_ptr<OpenBench> bench, std::uint64_t seed,
                                 const RunOptions& o) {
  auto m = std::make_unique<Impl>();
  s.params.seed = seed;
  s.record.as_seen = true, s.record.tracks = false;
  m->seed = seed, m->options = o;
  m->pool = std::make_unique<Pool>(o.threads);
  m->bench = std::move(bench);
  const Frame frame = BenchControls(s).frame;  // what does not fit is said before anything is written
  check_recording(s.record, frame, s.camera.rate);

  m->bench->try_coils();
  m->directory = RunDirectory::make({o.out, o.numbered, o.force, ""});
  const std::filesystem::path dir = m->directory.path();
  m->rig = &m->bench->rig(dir / run_files::kCoilsLog);
  if (!s.rig->params.delay) s.rig->params.delay = std::round(m->bench->delay(s) * kDelaySteps) / kDelaySteps;
  m->rig->begin();
  const GuardReport guard = m->rig->coils()->report();
  m->commands_before = guard.passed, m->refused_before = guard.refused;
  m->rests_before = m->rig->coils()->rests();
  m->scenario = std::move(s);
  m->controls = std::make_unique<BenchControls>(m->scenario);
  write_file(dir / run_files::kScenario, to_toml(m->scenario.resolved()));
  const SinkContext c{.dir = dir,
                      .world = nullptr,
                      .field = m->controls->field,
                      .loop = nullptr,
                      .frame = frame,
                      .scale = m->scenario.si_scale(),
                      .frame_rate = m->scenario.camera.rate,
                      .record = m->scenario.record,
                      .jitter = true,
                      .flow = m->scenario.flow,
                      .pool = m->pool.get()};
  m->sinks.push_back(series_sink(c, nullptr));
  if (c.record.video) m->sinks.push_back(video_sink(c, false, nullptr));
  if (c.record.lossless) m->sinks.push_back(video_sink(c, true, nullptr));
  if (c.record.flow) m->sinks.push_back(flow_sink(c, nullptr));
  m->commands = commands_sink(c);
  m->loop = std::make_unique<Loop>(m->controls->loop(*m->rig, m->scenario.frame_period()));
  return BenchSession(std::move(m));
}

bool BenchSession::run() {
  Impl& m = *impl_;
  std::vector<Sink*> all{m.commands.get()};
  for (auto& s : m.sinks) all.push_back(s.get());
  Recorder recorder(all);
  Loop& loop = *m.loop;
  loop.sinks = {&recorder};
  const double duration = m.scenario.params.duration;
  const auto finish = [&] {
    m.most_behind = recorder.most_behind();
    m.manifest = describe();
    OutputFile latency(dir() / "latency.csv");
    latency.append("frame,arrival_ms,command_ms\n");
    const auto ms = [](double s) { return std::isnan(s) ? std::string() : fmt::format("{:.4f}", 1e3 * s); };
    for (std::size_t i = 0; i < m.rig->delays().size(); ++i)
      latency.append(
          fmt::format("{},{},{}\n", i, ms(m.rig->delays()[i].arrival), ms(m.rig->delays()[i].command)));
    recorder.finish();
    for (auto& s : m.sinks) s->finish(false);
    write_file(dir() / run_files::kManifest, m.manifest.dump(2) + "\n");
  };
  try {
    const Urgent urgent;
    faba::run(loop, std::numeric_limits<std::uint64_t>::max(), [&] {
      if (m.options.progress)
        m.options.progress(std::uint64_t(1e3 * std::min(loop.last_t, duration)),
                           std::uint64_t(1e3 * duration));
      // What parts do but once, such as laying out their memory, they have done by now.
      if (loop.next == 1) m.rig->arm();
      m.whole = loop.last_t + 0.5 * loop.frame_period >= duration;
      return !m.whole && !(m.options.stop && m.options.stop->load());
    });
    const bool by_hand = !m.whole && m.options.stop && m.options.stop->load();
    if (by_hand)
      m.notes.push_back(fmt::format("ended by hand after {:.3g} s of {:.3g} s", loop.last_t, duration));
    if (loop.next == 0 && !by_hand) throw Error(Errc::device, "camera", "has no more pictures");
    // A video that is played may end before.
    if (!m.whole && !by_hand) {
      m.whole = true;
      m.notes.push_back(
          fmt::format("the camera's pictures ended after {:.3g} s of {:.3g} s", loop.last_t, duration));
    }
  } catch (const Error& e) {
    m.notes.push_back(fmt::format("ended by {}", e.what()));
    if (loop.next > 0) finish();
    throw;
  }
  finish();
  return m.whole;
}

const Json& BenchSession::manifest() const { return impl_->manifest; }

Json BenchSession::describe() const {
  const Impl& m = *impl_;
  const Scenario& s = m.scenario;
  std::vector<double> arrival, command;
  for (const BenchRig::Delay& d : m.rig->delays()) arrival.push_back(d.arrival), command.push_back(d.command);
  const GuardReport guard = m.rig->coils()->report();
  Json j = scenario_manifest(s, m.seed, m.controls->frame, s.arena.make({s.si_scale()})->outline());
  j.update(
      {{"complete", m.whole},
       {"rig", {{"camera", s.rig->camera.type}, {"driver", s.rig->driver.type}}},
       {"frames", m.loop->next},
       {"duration_s", m.loop->last_t + m.loop->frame_period},
       {"wall_time_s", std::chrono::duration<double>(std::chrono::steady_clock::now() - m.began).count()},
       {"notes", m.notes},
       {"setpoints", m.controls->reference->setpoints().size()},
       {"video_shows", "camera"},
       {"frames_dropped", m.rig->dropped()},
       {"delay_ms", 1e3 * s.rig->params.delay.value_or(0)},
       {"frames_corrupt", m.rig->feed().camera().corrupt()},
       {"arrival_ms", in_ms(arrival)},
       {"command_ms", in_ms(command)},
       {"recorder_most_behind", m.most_behind},
       {"guard",
        {{"state", word(guard.state)},
         {"commands", guard.passed - m.commands_before},
         {"refused", guard.refused - m.refused_before},
         {"rests", m.rig->coils()->rests() - m.rests_before},
         {"heat", guard.heat}}}});
  return j;
}

}  // namespace faba
