#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"

namespace faba {

/// Four numbers of how long something took, ms; not a number when it never happened.
struct Latency {
  double median = 0, p99 = 0, p999 = 0, max = 0;
};

/// What a run says about itself in its manifest.json (docs/formats/run-directory.md).
struct Manifest {
  std::string title, scenario_hash;
  std::uint64_t seed = 0;
  double um_per_px = 0;
  Vec2 view_px;  ///< width and height of the picture
  std::string arena_type;
  Vec2 arena_centre_px;
  double arena_radius_px = 0;  ///< of a drop; 0: the arena is a rectangle as large as the view
  std::string polarity;        ///< "north" or "south": of the cells that are steered
  bool complete = false;
  std::uint64_t frames = 0;  ///< turns of the control loop
  double duration_s = 0, wall_time_s = 0;
  std::size_t setpoints = 0;  ///< that the reference gives, also those that were not reached
  std::optional<double> setpoint_tolerance_px;  ///< within which the reference takes one for reached
  std::string video_shows;                      ///< "camera" or "drawing"
  std::string distance_source;                  ///< "true" or "estimated": of distance_px in series.csv
  std::vector<std::string> notes;

  /// Of a swarm that was simulated.
  struct Swarm {
    faba::Swarm::Params params;
    std::string model, start;
  };
  /// Of a simulation.
  struct Simulated {
    unsigned threads = 0;
    std::string state_hash;
    double step_s = 0;
    std::uint64_t steps = 0, cells = 0;
    std::vector<Swarm> swarms;
  };
  std::optional<Simulated> simulated;

  /// Of a bench.
  struct Bench {
    std::string camera, driver;
    std::uint64_t frames_dropped = 0, frames_corrupt = 0;
    double delay_ms = 0;       ///< that controllers reckon with
    Latency arrival, command;  ///< from mid-exposure to the program, from there to the coils
    std::size_t recorder_most_behind = 0;
    std::string guard_state;
    std::uint64_t guard_commands = 0, guard_refused = 0, command_timeouts = 0;
    double guard_heat = 0;  ///< of the warmest coil, 1 at its limit
  };
  std::optional<Bench> bench;
};

/// What any run of a scenario says about it. `frame` and `outline` are of the scenario's arena.
Manifest manifest_of(const Scenario& s, std::uint64_t seed, const Frame& frame, const Outline& outline);

/// As manifest.json has them.
Json swarm_json(const Manifest::Swarm& s);
Json manifest_json(const Manifest& m);

}  // namespace faba
