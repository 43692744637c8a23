#pragma once
#include <vector>

#include "app/scenario/scenario.h"
#include "core/toml.h"
#include "study/identify/response_video.h"
#include "study/sweep/variant.h"

namespace faba {

/// Key of a [[model]]: number of swarms with equal numbers of cells, of which each has parameters of its own.
inline constexpr const char* kPopulations = "populations";

/// Settings of a simulated episode that are not determined by its video.
struct EpisodeSettings {
  Boundary boundary = Boundary::drop;
  Json scene = Json::object();     ///< tables of a scenario that all candidates share
  Variant model;                   ///< `extra` may have the number of populations, see kPopulations
  double field_strength_t = 1e-3;  ///< strength of the applied field, T
  double scale_factor = 1;         ///< simulated over stated micrometres per pixel
};

/// Times of the field segments in a simulation of an episode.
struct SegmentTiming {
  double lead_s = 0;             ///< simulated time before the start of the episode
  std::vector<double> starts_s;  ///< start of each segment, relative to the start of the simulation
};
/// The times of the episode.
SegmentTiming exact_timing(const Episode& episode);
/// What is not known about the times of an episode.
struct TimingErrors {
  double sd_s = 0;         ///< standard deviation of the times of the segments
  double frame_s = 1;      ///< duration of a frame
  int clock_frames = 1;    ///< frames after which the clock of the model repeats
  int history_frames = 0;  ///< simulated before every episode
};
/// The times of the episode with normally distributed errors, truncated at 2.5 sd, and sorted. The times are
/// known to about one frame only, in which a cell can swim tens of pixels. A video does not show at which of
/// its frames a model with a clock draws new velocities: the lead is uniform over the period of the clock.
SegmentTiming random_timing(const Episode& episode, const TimingErrors& errors, std::uint64_t seed);

/// Scenario of an episode: arena, illumination, noise, field of view, initial cell positions, and the field
/// of its segments. Before the first segment the field is opposite to it and the cells are aligned; without a
/// boundary the field is zero and the headings are random.
Document episode_scenario(const ResponseVideo& video, const Episode& episode, const EpisodeSettings& settings,
                          const SegmentTiming& timing);

/// How a simulated episode is observed.
enum class Look {
  video,     ///< as frames rendered through the microscope
  positions  ///< as positions of all cells in view: faster, without camera effects
};

/// Observation of a simulated episode at the given times: frames or positions, as Look.
struct EpisodeObservation {
  std::vector<GrayF> frames;
  std::vector<std::vector<Vec2>> positions;
};
/// What is simulated before an episode.
struct EpisodeLead {
  double duration_s = 0;     ///< lead_s of SegmentTiming
  double direction_deg = 0;  ///< of the first segment; y points down
};
/// `places` in the order of the cells at `like`: the cells in a narrow strip along the direction get the
/// places of that strip, the first cell the first place. So the places of the cells remain related to their
/// properties: slow cells are behind fast ones. Equal sizes; y points up.
std::vector<Vec2> rearranged(const std::vector<Vec2>& places, const std::vector<Vec2>& like,
                             double direction_deg);
/// Simulates an episode on the calling thread. At the start of the episode the cells have the initial
/// positions of the scenario, rearranged as they are after the lead.
EpisodeObservation simulate_episode(const Scenario& s, std::uint64_t seed, const EpisodeLead& lead,
                                    const std::vector<double>& times_s, Look look,
                                    const std::shared_ptr<const VideoBackground>& ground);

}  // namespace faba
