#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>

#include "app/recording/recording.h"
#include "app/run/simulation.h"

namespace faba {

/// Options of a run that do not change its result.
struct RunOptions {
  std::filesystem::path out;     ///< run directory
  bool numbered = false;         ///< use out-2, out-3 ... if it exists
  std::string program = "faba";  ///< program of the resume command
  bool force = false;            ///< replace an existing run
  unsigned threads = 0;          ///< 0: number of hardware threads
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< called after every frame
  const std::atomic<bool>* stop = nullptr;                                ///< set to true to stop the run
};

/// A recorded run in its directory. The directory has a file `incomplete` until the run is complete. A run
/// that was interrupted or killed is resumed from its last checkpoint; its result is bit-identical to that of
/// an uninterrupted run.
class Session {
 public:
  /// Creates the directory and opens its files. All checks are done first: on Error(usage) nothing has been
  /// written.
  static Session begin(const Scenario& s, std::uint64_t seed, const RunOptions& o);
  /// Resumes the run in `o.out`. Throws Error(input) if there is no run to resume, Error(usage) if the run is
  /// complete or another process is writing it.
  static Session resume(const Parts& parts, const RunOptions& o);
  Session(Session&&) = default;
  ~Session();

  /// Runs to the end, or until stopped; then writes a checkpoint. Returns whether the end was reached.
  bool run();
  /// Content of manifest.json, after run().
  const Manifest& manifest() const { return recording_.manifest(); }
  /// series.csv, after run().
  Table series() const { return recording_.series(); }
  /// Frames of the video for the report, after run(); empty if none were kept.
  std::vector<SmallFrame> frames() const { return recording_.frames(); }
  /// To be called after the report is written: the directory is complete.
  void complete() { recording_.complete(); }

  const Scenario& scenario() const { return scenario_; }
  /// Warnings about the scenario: scenario_notes().
  const std::vector<std::string>& notes() const { return notes_; }
  const std::filesystem::path& dir() const { return recording_.dir(); }

 private:
  Session(Scenario s, std::uint64_t seed, const RunOptions& o);
  void record(RunDirectory directory, Archive* resume);
  void checkpoint();
  Manifest manifest_now() const;

  Scenario scenario_;
  std::uint64_t seed_;
  RunOptions options_;
  std::vector<std::string> notes_;
  std::unique_ptr<Pool> pool_;
  std::unique_ptr<Simulation> simulation_;
  Recording recording_;
};

}  // namespace faba
