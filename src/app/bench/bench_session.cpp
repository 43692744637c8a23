#include "app/bench/bench_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/bench/bench_controls.h"
#include "app/recording/session.h"
#include "control/obstacles_px.h"
#include "control/two_swarms.h"
#include "core/file.h"
#include "core/statistics.h"
#include "core/threads/urgent.h"

namespace faba {
namespace {

constexpr double kDelaySteps = 1e4;  // per second; measured delays are rounded to a multiple of 0.1 ms

// Quantiles in ms of the delays in s that are not NaN.
Latency in_ms(std::vector<double> s) {
  std::erase_if(s, [](double x) { return std::isnan(x); });
  return {1e3 * quantile(s, 0.5), 1e3 * quantile(s, 0.99), 1e3 * quantile(s, 0.999), 1e3 * quantile(s, 1)};
}

void write_latency(const std::filesystem::path& file, const BenchRig& rig) {
  OutputFile out(file);
  out.append("frame,arrival_ms,command_ms\n");
  const auto ms = [](double s) { return std::isnan(s) ? std::string() : fmt::format("{:.4f}", 1e3 * s); };
  for (std::size_t i = 0; i < rig.delays().size(); ++i)
    out.append(fmt::format("{},{},{}\n", i, ms(rig.delays()[i].arrival), ms(rig.delays()[i].command)));
  out.sync();
  out.close();
}

// The guard does not sync its log while it runs, because it must answer in time. At the end of a run, also
// after a trip, this process does; the guard syncs once more when it exits. In a series of step responses the
// log is not in the directory of a run.
void sync_log(const std::filesystem::path& log) {
  std::error_code ec;
  if (std::filesystem::exists(log, ec)) sync_file(log);
}

/// The camera of a bench: its pictures are part of the observations.
class BenchFrames final : public FrameSource {
 public:
  double time_of(const Tick& t) const override { return t.seen.t; }
  std::optional<double> planned_time(std::uint64_t) const override { return std::nullopt; }
  ImageRef picture(const Tick& t) const override { return t.seen.image; }
  int bits() const override { return 8; }
  const Image<std::uint16_t>& deep_picture() const override {
    throw Error(Errc::internal, "camera", "has no 16-bit pictures; a bench camera gives 8 bits");
  }
};

}  // namespace

struct BenchSession::Impl {
  Scenario scenario;
  std::uint64_t seed;
  RunOptions options;
  std::unique_ptr<Pool> pool;
  std::unique_ptr<BenchControls> controls;
  std::shared_ptr<OpenBench> bench;
  BenchRig* rig = nullptr;  ///< owned by `bench`
  Recording recording;
  std::unique_ptr<RunSink> commands;
  std::unique_ptr<Loop> loop;
  std::size_t most_behind = 0;
  std::uint64_t commands_before = 0, refused_before = 0,
                timeouts_before = 0;  ///< counters of earlier runs on the same bench
  bool complete = false;
  std::vector<std::string> notes;
  Manifest manifest;  ///< at the end of the run
};

BenchSession::BenchSession(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BenchSession::~BenchSession() = default;
BenchSession::BenchSession(BenchSession&&) noexcept = default;
const std::filesystem::path& BenchSession::dir() const { return impl_->recording.dir(); }
void BenchSession::complete() { impl_->recording.complete(); }

BenchSession BenchSession::begin(Scenario s, std::shared_ptr<OpenBench> bench, std::uint64_t seed,
                                 const RunOptions& o) {
  auto m = std::make_unique<Impl>();
  s.params.seed = seed;
  s.record.as_seen = true;
  s.record.tracks = false;
  if (!s.rig->camera.has(Trait::simulated)) s.scale.require_known();
  if (s.record.from > 0 || s.record.to)
    throw Error(Errc::usage, s.record.from > 0 ? "record.from" : "record.to",
                "a run on a bench is recorded from its start to its end; remove this key");
  m->seed = seed;
  m->options = o;
  m->pool = std::make_unique<Pool>(o.threads);
  m->bench = std::move(bench);
  const Frame frame = BenchControls(s).frame;  // throws before anything is written
  check_recording(s.record, frame, s.camera.rate);

  m->bench->try_coils();
  RunDirectory directory = RunDirectory::make({o.out, o.numbered, o.force, ""});
  const std::filesystem::path dir = directory.path();
  m->rig = &m->bench->rig(dir / run_files::kCoilsLog);
  if (!s.rig->params.delay) s.rig->params.delay = std::round(m->bench->delay(s) * kDelaySteps) / kDelaySteps;
  m->rig->begin();
  const GuardReport guard = m->rig->coils()->report();
  m->commands_before = guard.passed;
  m->refused_before = guard.refused;
  m->timeouts_before = m->rig->coils()->command_timeouts();
  if (const std::string note = scale_note(s.scale); !note.empty()) m->notes.push_back(note);
  m->scenario = std::move(s);
  m->controls = std::make_unique<BenchControls>(m->scenario);
  m->recording = Recording(std::move(directory), m->scenario, false);
  const SinkContext c{.dir = dir,
                      .frames = std::make_shared<BenchFrames>(),
                      .field = m->controls->field,
                      .frame = frame,
                      .scale = m->scenario.si_scale(),
                      .um_per_px = m->scenario.scale.um_per_px,
                      .frame_rate = m->scenario.camera.rate,
                      .record = m->scenario.record,
                      .jitter = true,
                      .flow = m->scenario.flow,
                      .pool = m->pool.get()};
  m->recording.open_sinks(c, nullptr);
  m->commands = commands_sink(c);
  m->loop = std::make_unique<Loop>(m->controls->loop(*m->rig, m->scenario.frame_period()));
  return BenchSession(std::move(m));
}

bool BenchSession::run() {
  Impl& m = *impl_;
  std::vector<Sink*> all{m.commands.get()};
  for (Sink* s : m.recording.sinks()) all.push_back(s);
  Recorder recorder(all);
  Loop& loop = *m.loop;
  loop.sinks = {&recorder};
  if (Sink* shown = m.bench->shown()) loop.sinks.push_back(shown);
  const double duration = m.scenario.params.duration;
  const auto finish = [&] {
    m.most_behind = recorder.most_behind();
    m.manifest = describe();
    write_latency(dir() / "latency.csv", *m.rig);
    recorder.finish();
    m.commands->finish(false);
    const GuardReport guard = m.rig->coils()->report();
    const bool logged = guard.log_failure.front() == '\0';
    m.manifest.complete = m.manifest.complete && logged;
    m.recording.finish(m.manifest, false);
    sync_log(dir() / run_files::kCoilsLog);
    if (!logged) throw Error(Errc::internal, "", guard.log_failure.data());
  };
  try {
    const Urgent urgent;
    faba::run(loop, std::numeric_limits<std::uint64_t>::max(), [&] {
      if (m.options.progress)
        m.options.progress(std::uint64_t(1e3 * std::min(loop.last_t, duration)),
                           std::uint64_t(1e3 * duration));
      // One-time work of the parts, such as the allocation of memory, is done by now.
      if (loop.next == 1) m.rig->arm();
      m.complete = loop.last_t + 0.5 * loop.frame_period >= duration;
      return !m.complete && !(m.options.stop && m.options.stop->load());
    });
    const bool stopped_by_user = !m.complete && m.options.stop && m.options.stop->load();
    if (stopped_by_user)
      m.notes.push_back(fmt::format("stopped by the user after {:.3g} s of {:.3g} s", loop.last_t, duration));
    if (loop.next == 0 && !stopped_by_user) throw Error(Errc::device, "camera", "no pictures received");
    // A camera that plays back a video may end earlier.
    if (!m.complete && !stopped_by_user) {
      m.complete = true;
      m.notes.push_back(fmt::format("the camera stopped after {:.3g} s of {:.3g} s", loop.last_t, duration));
    }
  } catch (const Error& e) {
    m.notes.push_back(fmt::format("stopped by an error: {}", e.what()));
    try {
      if (loop.next > 0) finish();
    } catch (const Error&) {  // the error that stopped the run is reported instead
    }
    throw;
  }
  finish();
  return m.complete;
}

const Manifest& BenchSession::manifest() const { return impl_->manifest; }
Table BenchSession::series() const { return impl_->recording.series(); }

Manifest BenchSession::describe() const {
  const Impl& m = *impl_;
  const Scenario& s = m.scenario;
  std::vector<double> arrival, command;
  for (const BenchRig::Delay& d : m.rig->delays()) {
    arrival.push_back(d.arrival);
    command.push_back(d.command);
  }
  const GuardReport guard = m.rig->coils()->report();
  Manifest all = manifest_of(s, m.seed, m.controls->frame, s.arena.make({s.si_scale()})->outline());
  all.complete = m.complete;
  all.frames = m.loop->next;
  all.duration_s = m.loop->last_t + m.loop->frame_period;
  all.wall_time_s = m.recording.wall_time();
  all.date = m.recording.date();
  all.out = dir();
  all.setpoints = setpoint_count(*m.controls->reference);
  all.setpoint_tolerance_px = m.controls->reference->tolerance_px();
  all.path_done = m.controls->reference->path_done();
  all.two_swarm_distances_px = two_swarm_distances_px(*m.controls->controller, s.si_scale().m_per_px);
  all.obstacles_px = obstacles_px(*m.controls->controller, m.controls->frame);
  all.video_shows = "camera";
  all.distance_source = "estimated";
  all.notes = m.notes;
  all.bench = Manifest::Bench{.camera = s.rig->camera.type,
                              .driver = s.rig->driver.type,
                              .frames_dropped = m.rig->dropped(),
                              .frames_corrupt = m.rig->feed().corrupt(),
                              .delay_ms = 1e3 * s.rig->params.delay.value_or(0),
                              .arrival = in_ms(arrival),
                              .command = in_ms(command),
                              .recorder_most_behind = m.most_behind,
                              .guard_state = word(guard.state),
                              .guard_commands = guard.passed - m.commands_before,
                              .guard_refused = guard.refused - m.refused_before,
                              .command_timeouts = m.rig->coils()->command_timeouts() - m.timeouts_before,
                              .guard_heat = guard.heat};
  return all;
}

}  // namespace faba
