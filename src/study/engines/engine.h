#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "study/engines/engine_settings.h"

namespace faba {

/// Tasks that one worker computes: one attempt.
struct Attempt {
  std::uint64_t id = 0;           ///< of this run of the command, from 1
  std::string tasks;              ///< as number_list()
  std::filesystem::path results;  ///< result file
  std::filesystem::path log;      ///< messages of the worker
};

/// How an attempt ended. A worker that computed all of its tasks has renamed its result file, whatever is
/// reported here.
struct AttemptEnd {
  std::uint64_t id = 0;
  std::string how;           ///< "exit code 0", "signal 9", "not in the queue any more"
  int exit = -1;             ///< exit code; -1: unknown or killed
  std::string where = {};    ///< "job 17_3"; empty: nothing to add to the number of the attempt
  std::string message = {};  ///< of the engine about this attempt
  std::string text() const {
    return (where.empty() ? how : where + ": " + how) + (message.empty() ? "" : ": " + message);
  }
};

/// Where workers run. An engine starts the command of a worker, `faba study work`, and reports when workers
/// end; it transports no results, which workers write to files.
class Engine {
 public:
  /// Attempts in a queue for each worker: they even out the differences of the workers.
  static constexpr unsigned kQueuedPerSlot = 4;
  /// Attempts that measure the time of a task, before a queue is filled with chunks of a suitable size.
  static constexpr unsigned kMeasuringWorkers = 4;
  virtual ~Engine() = default;
  /// Number of workers that run at a time.
  virtual unsigned slots() const = 0;
  /// Whether attempts can wait in a queue of the engine, because its workers start late.
  virtual bool queues() const { return false; }
  /// Number of attempts that the engine accepts while `running` run or wait. `measured`: whether the time of
  /// a task is known, so that many attempts can be submitted in a suitable size.
  virtual std::size_t accepts(std::size_t running, bool measured) const;
  /// Starts the workers of these attempts. False when the engine does not accept them at the moment; they can
  /// be submitted again by the same names. Throws Error(usage) when it never accepts them.
  virtual bool submit(std::span<const Attempt> attempts) = 0;
  /// The attempts that ended since the last call.
  virtual std::vector<AttemptEnd> ended() = 0;
  /// Time between two calls of ended(), s.
  virtual double period_s() const = 0;
  /// Ends all workers.
  virtual void cancel() = 0;
  /// What hinders the engine at the moment, in a sentence; empty: nothing.
  virtual std::string trouble() const { return {}; }
  /// Why no worker runs although attempts are submitted, for the progress bar; empty: one runs.
  virtual std::string waiting() const { return {}; }
};

/// The command of a worker, without the tasks.
struct WorkerCommand {
  std::filesystem::path program;    ///< of faba, absolute
  std::filesystem::path directory;  ///< of the study, absolute
  std::string study_hash;
  std::vector<std::string> words(const Attempt& attempt) const;
};

}  // namespace faba
