#include "app/session.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "app/checkpoint.h"
#include "app/notes.h"
#include "core/file.h"

namespace faba {
namespace {

using namespace run_files;
constexpr const char* kOurs[] = {kMarker,      kCheckpoint,      kScenario,       kManifest,
                                 "series.csv", "tracks.h5",      "tracks.h5.new", "video.mp4.part",
                                 "video.mp4",  "video.avi.part", "video.avi",     "report.html"};

// When the process began, in clock ticks since boot: tells a live writer from another process with its old
// number.
std::string started(long pid) {
  std::ifstream in(fmt::format("/proc/{}/stat", pid));
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto after_name = text.rfind(')');
  if (after_name == std::string::npos) return "";
  std::istringstream fields(text.substr(after_name + 2));
  std::string field;
  for (int i = 3; i <= 22 && fields >> field; ++i) {
  }
  return field;
}

void refuse_if_busy(const std::filesystem::path& dir) {
  std::ifstream in(dir / kMarker);
  long pid = 0;
  std::string since;
  if (!(in >> pid >> since) || pid == getpid()) return;
  if (const std::string now = started(pid); !now.empty() && now == since)
    throw Error(Errc::usage, dir.string(),
                fmt::format("process {} is writing here; wait for it or choose another --out", pid));
}

void mark(const std::filesystem::path& dir) {
  write_file(dir / kMarker, fmt::format("{} {}\nThis run is not complete. Go on with: faba resume {}\n",
                                        getpid(), started(getpid()), dir.string()));
}

bool holds_run(const std::filesystem::path& dir) {
  std::error_code ec;
  const auto has = [&](const char* name) { return std::filesystem::exists(dir / name, ec); };
  return has(kMarker) || (has(kManifest) && has(kScenario));
}

void make_directory(const std::filesystem::path& dir, bool force) {
  std::error_code ec;
  if (std::filesystem::exists(dir, ec)) {
    if (!std::filesystem::is_directory(dir, ec))
      throw Error(Errc::usage, dir.string(), "exists and is not a directory");
    if (!std::filesystem::is_empty(dir, ec)) {
      if (!holds_run(dir))
        throw Error(Errc::usage, dir.string(), "holds other files and no run; choose another --out");
      if (!force)
        throw Error(Errc::usage, dir.string(),
                    "already holds a run; choose another --out, or --force to replace it");
    }
    refuse_if_busy(dir);
    for (const char* name : kOurs) std::filesystem::remove(dir / name, ec);  // what is not ours stays
    return;
  }
  std::filesystem::create_directories(dir, ec);
  if (ec)
    throw Error(Errc::internal, dir.string(),
                fmt::format("cannot be made: {}; choose another --out", ec.message()));
}

}  // namespace

Session::Session(Scenario s, std::uint64_t seed, const RunOptions& o)
    : scenario_(std::move(s)),
      seed_(seed),
      options_(o),
      dir_(o.out),
      pool_(std::make_unique<Pool>(o.threads)),
      began_(std::chrono::steady_clock::now()) {
  scenario_.params.seed = seed;
  simulation_ = std::make_unique<Simulation>(scenario_, seed, *pool_);
}

Session::~Session() = default;

Session Session::begin(const Scenario& s, std::uint64_t seed, const RunOptions& o) {
  Session session(s, seed, o);
  make_directory(o.out, o.force);
  mark(o.out);
  write_file(o.out / kScenario, to_toml(session.scenario_.resolved()));
  session.open_sinks(nullptr);
  return session;
}

Session Session::resume(const Parts& parts, const RunOptions& o) {
  std::error_code ec;
  if (!std::filesystem::is_directory(o.out, ec))
    throw Error(Errc::input, o.out.string(), "no such run directory");
  if (!std::filesystem::exists(o.out / kMarker, ec)) {
    if (std::filesystem::exists(o.out / kManifest, ec))
      throw Error(Errc::usage, o.out.string(), "this run is complete");
    throw Error(Errc::input, o.out.string(), "is not a run directory");
  }
  refuse_if_busy(o.out);
  if (!std::filesystem::exists(o.out / kScenario, ec))
    throw Error(Errc::input, o.out.string(),
                "was broken off before anything was written; run the scenario again");
  const Scenario s = read_scenario(read_toml(o.out / kScenario), parts);
  if (!s.params.seed) throw Error(Errc::input, (o.out / kScenario).string(), "names no seed");
  if (!std::filesystem::exists(o.out / kCheckpoint, ec)) {  // killed before the first one: nothing to lose
    RunOptions again = o;
    again.force = true;
    return begin(s, *s.params.seed, again);
  }
  Session session(s, *s.params.seed, o);
  Archive saved = read_checkpoint(o.out / kCheckpoint, s.hash());
  session.simulation_->archive(saved);
  mark(o.out);
  session.open_sinks(&saved);
  return session;
}

void Session::open_sinks(Archive* resume) {
  const SinkContext c{dir_,
                      &simulation_->world(),
                      &simulation_->reference(),
                      simulation_->frame(),
                      scenario_.si_scale(),
                      scenario_.camera.rate,
                      scenario_.record,
                      scenario_.motility.type != "none"};
  sinks_.push_back(series_sink(c, resume));
  if (scenario_.record.tracks) sinks_.push_back(tracks_sink(c, resume));
  if (scenario_.record.video) sinks_.push_back(video_sink(c, false, resume));
  if (scenario_.record.lossless) sinks_.push_back(video_sink(c, true, resume));
  for (auto& s : sinks_) simulation_->loop().sinks.push_back(s.get());
}

void Session::checkpoint() {
  Archive a;
  simulation_->archive(a);
  for (auto& s : sinks_) s->checkpoint(a);
  write_checkpoint(dir_ / kCheckpoint, scenario_.hash(), a);
}

bool Session::run() {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t total = scenario_.frames();
  auto last = Clock::now();
  Loop& loop = simulation_->loop();
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
  write_file(dir_ / kManifest, manifest().dump(2) + "\n");
  return whole;
}

Json Session::manifest() const {
  const Loop& loop = simulation_->loop();
  const World& world = simulation_->world();
  const Outline outline = world.parts().arena->outline();
  const Frame frame = simulation_->frame();
  Json arena = {{"type", scenario_.arena.type},
                {"centre_px", {outline.centre_image.x, outline.centre_image.y}}};
  if (outline.radius_px > 0)
    arena["radius_px"] = outline.radius_px;
  else
    arena["size_px"] = {frame.width, frame.height};
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
  return {{"version", FABA_VERSION},
          {"title", scenario_.params.title},
          {"complete", loop.next == scenario_.frames()},
          {"scenario_hash", scenario_.hash()},
          {"seed", seed_},
          {"threads", pool_->threads()},
          {"state_hash", world.state().hash()},
          {"frames", loop.next},
          {"duration_s", double(loop.next) * scenario_.frame_period()},
          {"step_s", simulation_->step()},
          {"steps", world.state().step},
          {"wall_time_s", std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count()},
          {"um_per_px", scenario_.scale.um_per_px},
          {"view_px", {frame.width, frame.height}},
          {"arena", arena},
          {"polarity", scenario_.polarity() > 0 ? "north" : "south"},
          {"cells", world.state().agents.size()},
          {"swarms", swarms},
          {"setpoints", setpoints.size()},
          {"notes", notes_on(scenario_, *simulation_, dir_)}};
}

void Session::complete() {
  std::error_code ec;
  std::filesystem::remove(dir_ / kCheckpoint, ec);
  if (std::filesystem::remove(dir_ / kMarker, ec); ec)
    throw Error(Errc::internal, (dir_ / kMarker).string(),
                fmt::format("cannot be removed: {}", ec.message()));
}

}  // namespace faba
