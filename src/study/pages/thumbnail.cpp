#include "study/pages/thumbnail.h"

#include <algorithm>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "app/sinks/drawn_swarm.h"
#include "vision/files/picture.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr double kMoment = 2;               // s from the beginning: the swarm has begun to move
constexpr std::uint64_t kMostFrames = 60;   // of a fast camera
constexpr std::uint64_t kMostCells = 2000;  // that are simulated for a picture
constexpr std::uint64_t kSeed = 1;

// What the picture shows is where cells are and what they are told to do.
void make_cheap(Scenario& s) {
  std::uint64_t all = 0;
  for (const Swarm& swarm : s.swarms) all += swarm.params.count;
  for (Swarm& swarm : s.swarms)
    if (all > kMostCells)
      swarm.params.count = std::max<std::uint64_t>(1, swarm.params.count * kMostCells / all);
  s.record = {};
  s.events.clear();
}

}  // namespace

void write_scene_thumbnail(Scenario s, const std::filesystem::path& png) {
  make_cheap(s);
  Pool pool(1);
  Simulation simulation(s, kSeed, pool);
  const std::uint64_t frames = std::clamp<std::uint64_t>(std::uint64_t(kMoment / s.frame_period()), 1,
                                                         std::min(kMostFrames, s.frames()));
  struct Last final : Sink {
    Vec2 target;
    void take(const Tick& t) override { target = t.target.position; }
  } last;
  simulation.loop().sinks.push_back(&last);
  run(simulation.loop(), frames, [] { return true; });
  DrawnSwarm drawn(simulation.world(), simulation.loop(), s.si_scale().m_per_px * 1e6);
  write_png(png, drawn.draw(double(frames - 1) * s.frame_period(), last.target));
}

void write_run_thumbnail(const std::filesystem::path& run, const std::filesystem::path& png) {
  for (const char* name : {"video.mp4", "video.avi"}) {
    if (!std::filesystem::exists(run / name)) continue;
    VideoReader reader(run / name);
    RgbImage picture;
    double t_s = 0;
    while (reader.read_colours(picture, t_s) && t_s < kMoment) {
    }
    return write_png(png, picture);
  }
  write_scene_thumbnail(read_scenario(read_toml(run / run_files::kScenario), builtin_parts()), png);
}

}  // namespace faba
