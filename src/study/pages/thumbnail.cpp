#include "study/pages/thumbnail.h"

#include <algorithm>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "app/sinks/drawn_swarm.h"
#include "vision/files/picture.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr double kThumbnailTime = 2;       // s after the start, when the swarm has started to move
constexpr std::uint64_t kMaxFrames = 60;   // limit for fast cameras
constexpr std::uint64_t kMaxCells = 2000;  // simulated for a picture
constexpr std::uint64_t kSeed = 1;

// Reduces the cost of the simulation: fewer cells, no recording, no events.
void reduce_cost(Scenario& s) {
  std::uint64_t all = 0;
  for (const Swarm& swarm : s.swarms) all += swarm.params.count;
  for (Swarm& swarm : s.swarms)
    if (all > kMaxCells)
      swarm.params.count = std::max<std::uint64_t>(1, swarm.params.count * kMaxCells / all);
  s.record = {};
  s.events.clear();
}

}  // namespace

void write_scene_thumbnail(Scenario s, const std::filesystem::path& png) {
  reduce_cost(s);
  Pool pool(1);
  Simulation simulation(s, kSeed, pool);
  const std::uint64_t frames = std::clamp<std::uint64_t>(std::uint64_t(kThumbnailTime / s.frame_period()), 1,
                                                         std::min(kMaxFrames, s.frames()));
  struct Last final : Sink {
    Vec2 target;
    void take(const Tick& t) override { target = t.target.position; }
  } last;
  simulation.loop().sinks.push_back(&last);
  run(simulation.loop(), frames, [] { return true; });
  DrawnSwarm drawn(simulation.world(), simulation.loop(), s.si_scale().m_per_px * 1e6);
  RgbImage picture;
  drawn.draw(double(frames - 1) * s.frame_period(), last.target, picture);
  write_png(png, picture);
}

void write_run_thumbnail(const std::filesystem::path& run, const std::filesystem::path& png) {
  for (const char* name : {"video.mp4", "video.avi"}) {
    if (!std::filesystem::exists(run / name)) continue;
    VideoReader reader(run / name);
    RgbImage picture;
    double t_s = 0;
    while (reader.read_colours(picture, t_s) && t_s < kThumbnailTime) {
    }
    return write_png(png, picture);
  }
  write_scene_thumbnail(read_scenario(read_toml(run / run_files::kScenario), builtin_parts()), png);
}

}  // namespace faba
