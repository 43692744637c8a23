#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/recording/manifest.h"
#include "core/vec.h"

namespace faba {

/// Outline of the region accessible to the cells of a run, in image coordinates, px.
struct ArenaOutline {
  std::string type;  ///< type of the arena in the scenario
  Vec2 centre_px;
  std::optional<double> radius_px;  ///< of a drop
  std::optional<Vec2> size_px;      ///< width and height of a box
};

/// The contents of the `manifest.json` of a run. All but the version are optional.
struct RunInfo {
  std::string version;          ///< of the program that made the run
  std::string title, polarity;  ///< empty when not given, like all strings here
  std::string seed, threads, state_hash, scenario_hash;
  std::string video_shows;          ///< "camera" or "drawing"
  bool complete = true;             ///< false when the run was stopped before its end
  bool open_loop = false;           ///< no controller of the run uses the setpoints; not in manifest.json
  std::optional<double> um_per_px;  ///< image scale, micrometre per pixel, > 0; empty: not known
  std::optional<double> nominal_um_per_px;  ///< used for the simulation when the scale is not known
  std::string um_per_px_source;             ///< "calibration", "typed" or "metadata"
  std::optional<double> duration_s, wall_time_s;
  std::optional<double> setpoints;              ///< number of setpoints of the scenario
  std::optional<double> setpoint_tolerance_px;  ///< distance within which a setpoint counts as reached
  std::optional<double> path_done;              ///< followed fraction of the path of the reference, 0 to 1
  /// Distances of two swarms from a setpoint each at the end, as their controller follows them.
  std::optional<std::array<double, 2>> two_swarm_distances_px;
  std::vector<std::vector<Vec2>> obstacles_px;  ///< polygons that the controller keeps the mean out of
  std::optional<Vec2> view_px;                  ///< width and height of the frames
  std::optional<ArenaOutline> arena;
  std::vector<std::string> notes;          ///< notes on doubtful settings
  std::vector<std::string> swarms;         ///< one line per swarm: "count 500, model adapted"
  std::vector<std::uint64_t> swarm_cells;  ///< number of cells per swarm; 0 when not given
};

/// The same for a run in memory.
RunInfo run_info(const Manifest& m);

/// Reads a manifest: a JSON object with `version` and optionally `seed, threads, state_hash, scenario_hash,
/// video_shows, duration_s, um_per_px, um_per_px_source, nominal_um_per_px, title, wall_time_s, view_px = [w,
/// h], arena = {type, centre_px, radius_px | size_px}, polarity, swarms = [{count, ...}], setpoints,
/// setpoint_tolerance_px, path_done, two_swarm_distances_px = [first, second], obstacles_px =
/// [[[x, y], ..], ..], notes = [..]`. null counts as
/// missing; unknown keys are ignored. Throws Error(Errc::input) with file and key when the file is missing or
/// not JSON, and for a value of the wrong type.
RunInfo read_run_info(const std::filesystem::path& path);

}  // namespace faba
