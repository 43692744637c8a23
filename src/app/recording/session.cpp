#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"

#include <fmt/format.h>
#include <algorithm>

#include "app/recording/checkpoint.h"
#include "app/run/notes.h"
#include "control/obstacles_px.h"
#include "control/setpoint_count.h"
#include "control/two_swarms.h"
#include "core/file.h"
#include "vision/files/video_libraries.h"

namespace faba {

using namespace run_files;

Session::Session(Scenario s, std::uint64_t seed, const RunOptions& o)
    : scenario_(std::move(s)), seed_(seed), options_(o), pool_(std::make_unique<Pool>(o.threads)) {
  scenario_.params.seed = seed;
  // After the threads of the pool: the dynamic linker lets no thread start while it loads a library.
  if (scenario_.record.video) load_video_libraries();
  simulation_ = std::make_unique<Simulation>(scenario_, seed, *pool_);
}

Session::~Session() = default;

Session Session::begin(const Scenario& s, std::uint64_t seed, const RunOptions& o) {
  Session session(s, seed, o);
  check_recording(s.record, session.simulation_->frame(), s.camera.rate);
  session.record(RunDirectory::make({o.out, o.numbered, o.force, o.program}), nullptr);
  return session;
}

Session Session::resume(const Parts& parts, const RunOptions& o) {
  std::error_code ec;
  if (!std::filesystem::exists(o.out, ec))
    throw Error(Errc::input, o.out.string(),
                "directory not found; give a run directory, such as runs/steer-1");
  if (!std::filesystem::is_directory(o.out, ec))
    throw Error(Errc::input, o.out.string(), "is a file; specify a run directory");
  if (!RunLock::marks(o.out)) {
    if (std::filesystem::exists(o.out / kManifest, ec))
      throw Error(Errc::usage, o.out.string(), "the run is complete; there is nothing to resume");
    throw Error(Errc::input, o.out.string(),
                "is not a run directory: it has no manifest.json; give the directory of a run");
  }
  if (std::filesystem::exists(o.out / kCommands, ec) || std::filesystem::exists(o.out / kCoilsLog, ec))
    throw Error(Errc::usage, o.out.string(),
                "is a run on a bench, which cannot be resumed; the recorded data are kept");
  RunLock lock(o.out, o.program);
  if (!std::filesystem::exists(o.out / kScenario, ec))
    throw Error(Errc::input, o.out.string(),
                "the run was interrupted before anything was written; run the scenario again");
  const Scenario s = read_scenario(read_toml(o.out / kScenario), parts);
  if (!s.params.seed) throw Error(Errc::input, (o.out / kScenario).string(), "key \"seed\" is missing");
  // Without a checkpoint the run was killed before the first one: start from scratch.
  if (!std::filesystem::exists(o.out / kCheckpoint, ec)) {
    RunOptions again = o;
    again.force = true;
    lock = RunLock();  // begin() locks it again
    return begin(s, *s.params.seed, again);
  }
  Session session(s, *s.params.seed, o);
  Archive saved = read_checkpoint(o.out / kCheckpoint, s.hash());
  session.simulation_->archive(saved);
  session.record(RunDirectory(o.out, std::move(lock)), &saved);
  return session;
}

void Session::record(RunDirectory directory, Archive* resume) {
  recording_ = Recording(std::move(directory), scenario_, resume != nullptr);
  notes_ = scenario_notes(scenario_, *simulation_, dir());
  recording_.open_sinks(sink_context(scenario_, *simulation_, *pool_, dir()), resume);
  for (Sink* s : recording_.sinks()) simulation_->loop().sinks.push_back(s);
}

void Session::checkpoint() {
  // More than a checkpoint without pictures takes; memory that is reserved and not used costs nothing.
  constexpr std::size_t kBytesPerCell = 64, kOther = 1 << 16;
  Archive a;
  a.reserve(kBytesPerCell * simulation_->world().state().agents.size() + kOther);
  simulation_->archive(a);
  recording_.checkpoint(a);
}

bool Session::run() {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t total = scenario_.frames();
  auto last = Clock::now();
  Loop& loop = simulation_->loop();
  // A long frame is not finished after a stop request: resume computes it again from the last checkpoint.
  std::optional<Clock::time_point> stop_time;
  simulation_->rig().before_steps([&] {
    if (!options_.stop || !options_.stop->load()) return true;
    if (!stop_time) stop_time = Clock::now();
    return Clock::now() - *stop_time < std::chrono::seconds(1);
  });
  faba::run(loop, total, [&] {
    if (options_.progress) options_.progress(loop.next, total);
    const bool stop = options_.stop && options_.stop->load();
    const bool due =
        std::chrono::duration<double>(Clock::now() - last).count() >= scenario_.record.checkpoint;
    // Also at the end, so that a crash while files are completed loses nothing. Always before Rig::safe().
    if (stop || (due && recording_.seamless()) || loop.next == total) {
      checkpoint();
      last = Clock::now();
    }
    return !stop;
  });
  const bool complete = loop.next == total;
  recording_.finish(manifest_now(), !complete);
  return complete;
}

Manifest Session::manifest_now() const {
  const Loop& loop = simulation_->loop();
  const World& world = simulation_->world();
  Manifest m = manifest_of(scenario_, seed_, simulation_->frame(), world.parts().arena->outline());
  m.complete = loop.next == scenario_.frames();
  const FrameRange part = scenario_.recorded_frames();
  const std::uint64_t end = std::clamp(loop.next, part.first, part.end);
  m.frames = end - part.first;
  m.duration_s = double(m.frames) * scenario_.frame_period();
  if (part.first > 0 || part.end < scenario_.frames())
    m.recorded_s = {double(part.first) * scenario_.frame_period(), double(end) * scenario_.frame_period()};
  m.wall_time_s = recording_.wall_time();
  m.date = recording_.date();
  m.out = dir();
  m.setpoints = setpoint_count(simulation_->reference());
  m.setpoint_tolerance_px = simulation_->reference().tolerance_px();
  m.path_done = simulation_->reference().path_done();
  m.two_swarm_distances_px = two_swarm_distances_px(simulation_->controller(), scenario_.si_scale().m_per_px);
  m.obstacles_px = obstacles_px(simulation_->controller(), simulation_->frame());
  m.video_shows = scenario_.record.as_seen ? "camera" : "drawing";
  m.distance_source = "true";
  m.notes = notes_;
  Manifest::Simulated simulated{.threads = pool_->threads(),
                                .state_hash = simulation_->state_hash(),
                                .step_s = simulation_->step(),
                                .steps = world.state().step,
                                .cells = world.state().agents.size(),
                                .swarms = {}};
  for (const Swarm& s : scenario_.swarms) simulated.swarms.push_back({s.params, s.model.type, s.start.type});
  m.simulated = std::move(simulated);
  return m;
}

}  // namespace faba
