#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"

#include <fmt/format.h>
#include <algorithm>

#include "app/recording/checkpoint.h"
#include "app/recording/manifest.h"
#include "app/run/notes.h"
#include "core/file.h"

namespace faba {

using namespace run_files;

Session::Session(Scenario s, std::uint64_t seed, const RunOptions& o)
    : scenario_(std::move(s)),
      seed_(seed),
      options_(o),
      directory_(o.out, RunLock()),
      pool_(std::make_unique<Pool>(o.threads)),
      began_(std::chrono::steady_clock::now()) {
  scenario_.params.seed = seed;
  simulation_ = std::make_unique<Simulation>(scenario_, seed, *pool_);
}

Session::~Session() = default;

Session Session::begin(const Scenario& s, std::uint64_t seed, const RunOptions& o) {
  Session session(s, seed, o);
  check_recording(s.record, session.simulation_->frame(), s.camera.rate);
  session.directory_ = RunDirectory::make({o.out, o.numbered, o.force, o.program});
  session.notes_ = notes_on(s, *session.simulation_, session.dir());
  write_file(session.dir() / kScenario, to_toml(session.scenario_.resolved()));
  session.open_sinks(nullptr);
  return session;
}

Session Session::resume(const Parts& parts, const RunOptions& o) {
  std::error_code ec;
  if (!std::filesystem::is_directory(o.out, ec))
    throw Error(Errc::input, o.out.string(), "no such run directory");
  if (!RunLock::marks(o.out)) {
    if (std::filesystem::exists(o.out / kManifest, ec))
      throw Error(Errc::usage, o.out.string(), "this run is complete");
    throw Error(Errc::input, o.out.string(), "is not a run directory");
  }
  if (std::filesystem::exists(o.out / kCommands, ec) || std::filesystem::exists(o.out / kCoilsLog, ec))
    throw Error(Errc::usage, o.out.string(),
                "is a run on a bench, which cannot go on; what was recorded is in it");
  RunLock lock(o.out, o.program);
  if (!std::filesystem::exists(o.out / kScenario, ec))
    throw Error(Errc::input, o.out.string(),
                "was broken off before anything was written; run the scenario again");
  const Scenario s = read_scenario(read_toml(o.out / kScenario), parts);
  if (!s.params.seed) throw Error(Errc::input, (o.out / kScenario).string(), "names no seed");
  if (!std::filesystem::exists(o.out / kCheckpoint, ec)) {  // killed before the first one: nothing to lose
    RunOptions again = o;
    again.force = true;
    lock = RunLock();  // begin() takes it anew
    return begin(s, *s.params.seed, again);
  }
  Session session(s, *s.params.seed, o);
  Archive saved = read_checkpoint(o.out / kCheckpoint, s.hash());
  session.simulation_->archive(saved);
  session.directory_ = RunDirectory(o.out, std::move(lock));
  session.notes_ = notes_on(s, *session.simulation_, session.dir());
  session.open_sinks(&saved);
  return session;
}

void Session::open_sinks(Archive* resume) {
  const SinkContext c = sink_context(scenario_, *simulation_, *pool_, dir());
  sinks_.push_back(series_sink(c, resume));
  if (scenario_.record.tracks) sinks_.push_back(tracks_sink(c, resume));
  if (scenario_.record.video) sinks_.push_back(video_sink(c, false, resume));
  if (scenario_.record.lossless) sinks_.push_back(video_sink(c, true, resume));
  if (scenario_.record.flow) sinks_.push_back(flow_sink(c, resume));
  for (auto& s : sinks_) simulation_->loop().sinks.push_back(s.get());
}

void Session::checkpoint() {
  Archive a;
  simulation_->archive(a);
  for (auto& s : sinks_) s->checkpoint(a);
  write_checkpoint(dir() / kCheckpoint, scenario_.hash(), a);
}

bool Session::run() {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t total = scenario_.frames();
  auto last = Clock::now();
  Loop& loop = simulation_->loop();
  // A frame of very many steps is not waited for: it is done again by resume, from the last checkpoint.
  std::optional<Clock::time_point> asked;
  simulation_->rig().before_steps([&] {
    if (!options_.stop || !options_.stop->load()) return true;
    if (!asked) asked = Clock::now();
    return Clock::now() - *asked < std::chrono::seconds(1);
  });
  faba::run(loop, total, [&] {
    if (options_.progress) options_.progress(loop.next, total);
    const bool stop = options_.stop && options_.stop->load();
    const bool due =
        std::chrono::duration<double>(Clock::now() - last).count() >= scenario_.record.checkpoint;
    // Also at the end: a crash while files are completed then costs nothing. Before the rig is made safe, in
    // any case.
    if (stop || due || loop.next == total) checkpoint(), last = Clock::now();
    return !stop;
  });
  const bool whole = loop.next == total;
  for (auto& s : sinks_) s->finish(!whole);
  write_file(dir() / kManifest, manifest().dump(2) + "\n");
  return whole;
}

Json Session::manifest() const {
  const Loop& loop = simulation_->loop();
  const World& world = simulation_->world();
  Json swarms = Json::array();
  for (const Swarm& s : scenario_.swarms) {
    Json one = Swarm::schema().to_json(s.params);
    one["model"] = s.model.type;
    one["start"] = s.start.type;
    swarms.push_back(one);
  }
  std::vector<Vec2> setpoints = simulation_->reference().setpoints();
  setpoints.erase(std::unique(setpoints.begin(), setpoints.end()),
                  setpoints.end());  // as a series shows them
  Json j = scenario_manifest(scenario_, seed_, simulation_->frame(), world.parts().arena->outline());
  j.update({{"complete", loop.next == scenario_.frames()},
            {"threads", pool_->threads()},
            {"state_hash", world.state().hash()},
            {"frames", loop.next},
            {"duration_s", double(loop.next) * scenario_.frame_period()},
            {"step_s", simulation_->step()},
            {"steps", world.state().step},
            {"wall_time_s", std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count()},
            {"cells", world.state().agents.size()},
            {"swarms", swarms},
            {"setpoints", setpoints.size()},
            {"video_shows", scenario_.record.as_seen ? "camera" : "drawing"},
            {"notes", notes_}});
  return j;
}

void Session::complete() { directory_.complete(); }

}  // namespace faba
