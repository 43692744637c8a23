#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>

#include "app/recording/recording.h"
#include "app/run/simulation.h"

namespace faba {

/// How a run is carried out; nothing here changes its result.
struct RunOptions {
  std::filesystem::path out;     ///< run directory
  bool numbered = false;         ///< or out-2, out-3 ... when it exists
  std::string program = "faba";  ///< the command to go on with
  bool force = false;            ///< replace an earlier run there
  unsigned threads = 0;          ///< 0: all of the machine's
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< called after every frame
  const std::atomic<bool>* stop = nullptr;  ///< becomes true when the user wants to stop
};

/// A recorded run in a directory of its own. While it is being made the directory holds the file
/// `incomplete`; a run that was interrupted or killed goes on from its last checkpoint, and ends with the
/// same bits as one that was not.
class Session {
 public:
  /// Makes the directory and everything in it. All checks come first: on Error(usage) nothing has been
  /// written.
  static Session begin(const Scenario& s, std::uint64_t seed, const RunOptions& o);
  /// Goes on with the run in `o.out`. Throws Error(input) when there is nothing to go on with, Error(usage)
  /// when the run is complete or another process is at it.
  static Session resume(const Parts& parts, const RunOptions& o);
  Session(Session&&) = default;
  ~Session();

  /// Runs to the end, or until asked to stop; then a checkpoint is left. Returns whether the end was reached.
  bool run();
  /// What manifest.json says, or would say now.
  Manifest manifest() const;
  /// series.csv, after run().
  Table series() const { return recording_.series(); }
  /// Call when the report, too, is written: the directory is complete.
  void complete() { recording_.complete(); }

  const Scenario& scenario() const { return scenario_; }
  /// What is legal but probably not meant: notes_on().
  const std::vector<std::string>& notes() const { return notes_; }
  const std::filesystem::path& dir() const { return recording_.dir(); }

 private:
  Session(Scenario s, std::uint64_t seed, const RunOptions& o);
  void record(RunDirectory directory, Archive* resume);
  void checkpoint();

  Scenario scenario_;
  std::uint64_t seed_;
  RunOptions options_;
  std::vector<std::string> notes_;
  std::unique_ptr<Pool> pool_;
  std::unique_ptr<Simulation> simulation_;
  Recording recording_;
};

}  // namespace faba
