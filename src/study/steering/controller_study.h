#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"
#include "study/sweep/variant.h"

namespace faba {

/// What `faba compare-controllers` is asked for: every controller with every model and every delay of the
/// camera, each with the same seeds.
struct ControllerStudy {
  std::string title;
  Document scene;  ///< what all trials share
  std::vector<Variant> controllers, models;
  std::vector<int> delays;  ///< frames; empty: the scene's own
  int seeds = 20;           ///< trials of each combination, with seeds from `first_seed` on
  std::uint64_t first_seed = 1;
};
/// Reads a study file: `scene`, `seeds`, `first_seed`, `delays`, [[controller]], [[model]] (see Variant).
/// Throws Error(usage).
ControllerStudy read_controller_study(const std::filesystem::path& file);

/// A mean over seeds with its 95 % interval (Student's t).
struct MeanOverSeeds {
  double mean = 0, sd = 0;
  std::array<double, 2> ci95{};
  int n = 0;  ///< trials in which the quantity was defined
};

/// How a controller did over the seeds, with one model and one delay.
struct Combination {
  std::string controller, model;
  int delay = 0;                                 ///< frames
  std::map<std::string, MeanOverSeeds> metrics;  ///< by the names of Metrics, defined in one trial or more
  int settled = 0, trials = 0;
  std::array<double, 2> settled_ci95{};  ///< of the share that settles (Wilson)
  /// Mean over the seeds, and one standard deviation each way, frame by frame.
  std::vector<double> t_s, distance_px, distance_sd_px, rms_radius_px, rms_radius_sd_px;
  /// Steady error less that of the best controller with the same model, delay and seeds: mean of the paired
  /// differences, with interval. Empty for the best itself.
  std::optional<MeanOverSeeds> behind_best;
};

struct ControllerComparison {
  ControllerStudy study;
  std::vector<Combination> combinations;  ///< by model, delay and controller, in the order of the study
  std::vector<std::string> notes = {};    ///< what is legal in the scene but probably not meant
};

/// JSON Schema of a study file.
Json controller_study_schema();
/// Hash of all that the result depends on.
std::string study_hash(const ControllerStudy& study);
/// Runs what `results` has not yet. Checks every combination before the first trial. Empty when other shards
/// have tasks left. Throws Error(usage) for combinations that do not fit together, and what sweep() throws.
std::optional<ControllerComparison> compare_controllers(const ControllerStudy& study, ResultStore& results,
                                                        const SweepOptions& options);

}  // namespace faba
