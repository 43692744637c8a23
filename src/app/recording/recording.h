#pragma once
#include <chrono>
#include <memory>
#include <vector>

#include "app/recording/manifest.h"
#include "app/recording/run_directory.h"
#include "app/sinks/series.h"
#include "app/sinks/sinks.h"

namespace faba {

/// Writes a run directory, of a simulated run or a run on a bench: sinks, checkpoints and manifest.
class Recording {
 public:
  Recording() = default;
  /// `scenario`: written to the directory unless the run is resumed.
  Recording(RunDirectory directory, const Scenario& scenario, bool resumed);

  /// Opens the sinks given by the scenario's [record]; tracks only with ground truth. `resume`: null, or the
  /// checkpoint, from which the state of the run has already been read.
  void open_sinks(const SinkContext& c, Archive* resume);
  std::vector<Sink*> sinks() const;
  /// Syncs all files and writes the checkpoint: the state of the run in `a`, then the state of the sinks.
  void checkpoint(Archive& a);
  /// Whether a checkpoint in this cycle leaves the content of all files as it is without one.
  bool seamless() const;
  /// Completes all files and writes manifest.json. `keep`: keep the files that are needed to resume.
  void finish(const Manifest& m, bool keep);
  /// To be called after finish() and after the report is written: the directory is complete. Writes
  /// ro-crate-metadata.json and removes the marker.
  void complete();

  const std::filesystem::path& dir() const { return directory_.path(); }
  const Manifest& manifest() const { return manifest_; }  ///< as written by finish()
  /// series.csv, after finish().
  Table series() const { return series_->rows(); }
  /// Frames of the video for the report, after finish(); empty if none were kept.
  std::vector<SmallFrame> frames() const { return kept_ ? kept_->frames() : std::vector<SmallFrame>{}; }
  /// Wall time since the start of the recording, s.
  double wall_time() const;
  /// Start of the recording, UTC, as "2026-03-01T12:00:00Z".
  std::string date() const;

 private:
  RunDirectory directory_;
  std::string scenario_hash_;
  std::vector<std::string> inputs_;  ///< see input_files()
  Manifest manifest_;                ///< as written by finish()
  SeriesSink* series_ = nullptr;     ///< one of sinks_
  std::vector<std::unique_ptr<RunSink>> sinks_;
  std::vector<std::unique_ptr<Sink>> parts_;  ///< pass the recorded frames to sinks_
  std::shared_ptr<const KeptFrames> kept_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::chrono::system_clock::time_point date_ = std::chrono::system_clock::now();
};

}  // namespace faba
