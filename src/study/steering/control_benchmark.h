#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/steering/controller_study.h"

namespace faba {

/// One case of the benchmark of controllers: a scene with its conditions, for several controllers and delays.
struct BenchmarkCase {
  std::string name, about;
  std::string literature;       ///< published result with its source, and the differences of the set-ups
  std::optional<double> speed;  ///< m/s, of the cells, for the ratio of radius and speed
  ControllerStudy study;
};

struct ControlBenchmark {
  std::string title;
  int version = 1;
  std::vector<BenchmarkCase> cases;
};
/// Reads a benchmark: `title`, `version`, `seeds`, `first_seed`, [[controller]], and [[case]] with `name`,
/// `about`, `scene`, `set`, `delays`, `controllers`, `baseline`, `ranked_by`, `literature`, `speed`,
/// [[case.keep_out]]. `only`: names of the cases to keep; empty: all. Throws Error(usage).
ControlBenchmark read_control_benchmark(const std::filesystem::path& file,
                                        const std::vector<std::string>& only = {});
Json control_benchmark_schema();

struct ControlBenchmarkResult {
  ControlBenchmark benchmark;
  std::vector<ControllerComparison> cases;
};
std::string study_hash(const ControlBenchmark& benchmark);
/// One round for each case. Empty when tasks of other processes are missing. Throws the errors of sweep().
std::optional<ControlBenchmarkResult> run_control_benchmark(const ControlBenchmark& benchmark,
                                                            ResultStore& results,
                                                            const SweepOptions& options);
/// The round with this description; `benchmark` must outlive it. Throws Error(input) for another one.
Round control_benchmark_round(const ControlBenchmark& benchmark, const std::string& description,
                              const std::function<bool()>& stop);

/// How long the estimator and the controller of a combination take per frame on this machine.
struct CycleTime {
  std::string name, controller;  ///< of the case
  int delay = 0;                 ///< frames
  double median = 0, most = 0;   ///< s; `most`: 99.9 % of the frames are faster
  double worst = 0;              ///< s
  double frame_period = 0;       ///< s
};
std::vector<CycleTime> measured_cycle_times(const ControlBenchmark& benchmark,
                                            const std::function<bool()>& stop);

}  // namespace faba
