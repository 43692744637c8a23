#pragma once
#include <vector>

#include "app/scenario/scenario.h"
#include "core/toml.h"
#include "study/identify/response_video.h"
#include "study/sweep/variant.h"

namespace faba {

/// What an episode is simulated with, beside what its video tells.
struct EpisodeSettings {
  Boundary boundary = Boundary::drop;
  Json scene = Json::object();  ///< tables of a scenario that all candidates share
  Variant model;
  double field_strength_t = 1e-3;  ///< strength of the applied field, T
};

/// When the field turns in a simulation of an episode.
struct SegmentTiming {
  double lead_s = 0;            ///< how long the simulation runs before the episode is taken to begin
  std::vector<double> turns_s;  ///< beginning of each segment, from the simulation's own on
};
/// As the episode says.
SegmentTiming exact_timing(const Episode& episode);
/// Each turn off by a normal law of `sd_s`, but in order: the moments are known to a frame or so only, and at
/// tens of pixels per frame that shows.
SegmentTiming drawn_timing(const Episode& episode, double sd_s, std::uint64_t seed);

/// A scenario that repeats an episode: its place, light, noise and field of view, its cells where they were
/// seen, and the field along its segments. Before the first one the field is the opposite and has
/// turned the cells; without a boundary there is none, and they head anywhere.
Document episode_scenario(const ResponseVideo& video, const Episode& episode, const EpisodeSettings& settings,
                          const SegmentTiming& timing);

/// How a simulated episode is looked at.
enum class Look {
  video,     ///< through the microscope, as the video was
  positions  ///< every cell in view is known: quick, and blind to what a camera does
};

/// What is seen of a simulated episode at the moments asked for: one of the two.
struct SeenEpisode {
  std::vector<GrayF> frames;
  std::vector<std::vector<Vec2>> positions;
};
/// Simulates an episode on the calling thread. `lead_s` as in SegmentTiming.
SeenEpisode simulate_episode(const Scenario& s, std::uint64_t seed, double lead_s,
                             const std::vector<double>& times_s, Look look,
                             const std::shared_ptr<const VideoGround>& ground);

}  // namespace faba
