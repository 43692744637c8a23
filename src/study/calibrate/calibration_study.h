#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "study/identify/identify_study.h"

namespace faba {

/// Experiments of one kind: their cells and coils are as the study states, or differ from it.
struct ExperimentKind {
  std::string name;
  int experiments = 0;
  /// Candidates that are the true model, in turn.
  std::vector<std::size_t> true_models;
  double second_swarm = 0;                             ///< fraction of the cells that become swarm[1]
  double field_factor = 1;                             ///< true over stated field strength
  std::optional<double> timing_s = {};                 ///< true s.d. of the times of field reversals, s
  std::vector<std::pair<std::string, Json>> set = {};  ///< values of the true scenario, by path
  std::vector<std::string> aspects = {};               ///< of warnings that name the difference
  bool misspecified = false;
  std::string where = {};  ///< of `set` in the calibration file, for messages
};

/// Configuration of `faba calibrate`: a study for `faba identify`, whose design is simulated with true
/// parameters from its priors.
struct CalibrationStudy {
  std::string title;
  std::uint64_t seed = 1;
  IdentifyStudy design;     ///< with the candidates and the look of the calibration
  std::string designed_by;  ///< file name of the study
  std::vector<ExperimentKind> kinds;

  std::uint64_t experiments() const;
  /// Kind of an experiment, and its number in it.
  std::pair<std::size_t, std::uint64_t> kind_of(std::uint64_t experiment) const;
};

/// Reads a calibration file, or a study for `faba identify`, which is calibrated with the defaults. Throws as
/// read_identify_study().
CalibrationStudy read_calibration_study(const std::filesystem::path& file, bool needs_videos = true);
/// JSON Schema of a calibration file.
Json calibration_study_schema();
/// Hash of everything that the result depends on, with the digests of the videos.
std::string study_hash(const CalibrationStudy& study);

}  // namespace faba
