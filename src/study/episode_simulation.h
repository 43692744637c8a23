#pragma once
#include "app/scenario.h"
#include "core/toml.h"
#include "study/response_video.h"
#include "study/variant.h"

namespace faba {

/// What an episode is simulated with, beside what its video tells.
struct EpisodeSettings {
  Boundary boundary = Boundary::drop;
  Json scene = Json::object();  ///< tables of a scenario that all candidates share
  Variant model;
  double drive_t = 1e-3;  ///< strength of the field that drives the cells, T
};

/// A scenario that repeats an episode: its place, light, noise and field of view, its cells where they were
/// seen, and the field along its drives.
Document episode_scenario(const ResponseVideo& video, const Episode& episode,
                          const EpisodeSettings& settings);

/// How a simulated episode is looked at.
enum class Look {
  video,     ///< through the microscope, as the video was
  positions  ///< every cell in view is known: quick, and blind to what a camera does
};

/// Simulates an episode on the calling thread and measures it. `timing_s`: how well the moments are known at
/// which the field turns, sd: each drive is looked at so much too early or too late.
std::vector<double> simulate_episode(const Scenario& s, std::uint64_t seed, double timing_s,
                                     const EpisodeStatistics& statistics, Look look,
                                     const std::shared_ptr<const VideoGround>& ground);

}  // namespace faba
