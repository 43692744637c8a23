#pragma once
#include <chrono>
#include <memory>
#include <vector>

#include "app/recording/manifest.h"
#include "app/recording/run_directory.h"
#include "app/sinks/series.h"
#include "app/sinks/sinks.h"

namespace faba {

/// A run directory while it is filled: its sinks, its checkpoints and its manifest, whether the run is
/// simulated or on a bench.
class Recording {
 public:
  Recording() = default;
  /// `scenario`: as the run has it, written to the directory unless it is resumed.
  Recording(RunDirectory directory, const Scenario& scenario, bool resumed);

  /// Opens the sinks that the scenario's [record] asks for, tracks only where the truth is known. `resume`:
  /// null, or the checkpoint, read as far as what the run itself has put there.
  void open_sinks(const SinkContext& c, Archive* resume);
  std::vector<Sink*> sinks() const;
  /// Brings all files to the disk and writes the checkpoint: the run's own state in `a`, then where sinks
  /// stand.
  void checkpoint(Archive& a);
  /// Completes all files and writes manifest.json. `keep`: what is needed to resume stays.
  void finish(const Manifest& m, bool keep);
  /// Call when the report, too, is written: the directory is complete, and its marker is removed.
  void complete() { directory_.complete(); }

  const std::filesystem::path& dir() const { return directory_.path(); }
  /// series.csv, after finish().
  Table series() const { return series_->rows(); }
  /// Time on the clock since the recording began, s.
  double wall_time() const;

 private:
  RunDirectory directory_;
  std::string scenario_hash_;
  SeriesSink* series_ = nullptr;  ///< one of sinks_
  std::vector<std::unique_ptr<RunSink>> sinks_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace faba
