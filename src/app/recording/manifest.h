#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"

namespace faba {

/// Quantiles of a latency, ms; NaN if there are no values.
struct Latency {
  double median = 0, p99 = 0, p999 = 0, max = 0;
};

/// Content of manifest.json of a run (docs/formats/run-directory.md).
struct Manifest {
  std::string title, scenario_hash;
  std::uint64_t seed = 0;
  std::optional<double> um_per_px, nominal_um_per_px;  ///< nominal: of a picture of unknown scale
  Json um_per_px_source;                               ///< see scale_source_json()
  Vec2 view_px;                                        ///< width and height of the picture
  std::string arena_type;
  Vec2 arena_centre_px;
  double arena_radius_px = 0;  ///< of a drop; 0: the arena is a rectangle of the size of the view
  std::string polarity;        ///< "north" or "south": of the steered cells
  bool open_loop = false;      ///< no controller of the run uses the setpoints; not in manifest.json
  bool complete = false;
  std::uint64_t frames = 0;  ///< number of recorded frames, one per control cycle
  double duration_s = 0, wall_time_s = 0;
  /// Simulated times of the recorded part, s; empty: the run is recorded from its start to its end.
  std::optional<Vec2> recorded_s;
  std::string date;           ///< start of the recording by this process, UTC, ISO 8601
  std::filesystem::path out;  ///< run directory, as given
  std::size_t setpoints = 0;  ///< number of setpoints of the reference, reached or not
  std::optional<double>
      setpoint_tolerance_px;        ///< distance at which the reference counts a setpoint as reached
  std::optional<double> path_done;  ///< fraction of the path of the reference that the swarm has followed
  /// Distances of two swarms with a setpoint each at the end, px, as their controller follows them.
  std::optional<std::array<double, 2>> two_swarm_distances_px;
  std::vector<std::vector<Vec2>> obstacles_px;  ///< polygons that the controller keeps the mean out of
  std::string video_shows;                      ///< "camera" or "drawing"
  std::string distance_source;                  ///< "true" or "estimated": of distance_px in series.csv
  std::vector<std::string> notes;

  /// A simulated swarm.
  struct Swarm {
    faba::Swarm::Params params;
    std::string model, start;
  };
  /// Members of a simulated run.
  struct Simulated {
    unsigned threads = 0;
    std::string state_hash;
    double step_s = 0;
    std::uint64_t steps = 0, cells = 0;
    std::vector<Swarm> swarms;
  };
  std::optional<Simulated> simulated;

  /// Members of a run on a bench.
  struct Bench {
    std::string camera, driver;
    std::uint64_t frames_dropped = 0, frames_corrupt = 0;
    double delay_ms = 0;       ///< latency that controllers compensate
    Latency arrival, command;  ///< from mid-exposure to the program; from there to the coils
    std::size_t recorder_most_behind = 0;
    std::string guard_state;
    std::uint64_t guard_commands = 0, guard_refused = 0, command_timeouts = 0;
    double guard_heat = 0;  ///< thermal load of the warmest coil, 1 at its limit
  };
  std::optional<Bench> bench;
};

/// The members of any run of a scenario. `frame` and `outline` are those of its arena.
Manifest manifest_of(const Scenario& s, std::uint64_t seed, const Frame& frame, const Outline& outline);

/// JSON as in manifest.json.
Json swarm_json(const Manifest::Swarm& s);
Json manifest_json(const Manifest& m);

}  // namespace faba
