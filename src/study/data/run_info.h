#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/recording/manifest.h"
#include "core/vec.h"

namespace faba {

/// Where the cells of a run could be, in picture pixels.
struct ArenaOutline {
  std::string type;  ///< as the scenario names it
  Vec2 centre_px;
  std::optional<double> radius_px;  ///< of a drop
  std::optional<Vec2> size_px;      ///< width and height of a box
};

/// What a run says about itself in its `manifest.json`. Everything but the version may be missing.
struct RunInfo {
  std::string version;          ///< of the program that made the run
  std::string title, polarity;  ///< empty when not given, like all texts here
  std::string seed, threads, state_hash, scenario_hash;
  std::string video_shows;          ///< "camera" or "drawing"
  bool complete = true;             ///< false when the run was stopped before its end
  std::optional<double> um_per_px;  ///< picture scale, micrometre per pixel, > 0
  std::optional<double> duration_s, wall_time_s;
  std::optional<double> setpoints;              ///< that the scenario gives, also those that were not come to
  std::optional<double> setpoint_tolerance_px;  ///< within which the reference takes one for reached
  std::optional<Vec2> view_px;                  ///< width and height of the picture
  std::optional<ArenaOutline> arena;
  std::vector<std::string> notes;          ///< what was legal but could not work, or was hardly meant
  std::vector<std::string> swarms;         ///< one line per swarm: "count 500, model adapted"
  std::vector<std::uint64_t> swarm_cells;  ///< number of cells per swarm; 0 when not given
};

/// The same of a run that has just been made.
RunInfo run_info(const Manifest& m);

/// Reads a manifest: a JSON object with `version`, and as far as known `seed, threads, state_hash,
/// scenario_hash, video_shows, duration_s, um_per_px, title, wall_time_s, view_px = [w, h], arena = {type,
/// centre_px, radius_px | size_px}, polarity, swarms = [{count, ...}], setpoints, setpoint_tolerance_px,
/// notes = [..]`. null counts as missing; unknown keys are left alone. Throws Error(Errc::input) naming the
/// file and the key when the file is missing or not JSON, and for a value of the wrong kind.
RunInfo read_run_info(const std::filesystem::path& path);

}  // namespace faba
