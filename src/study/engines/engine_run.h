#pragma once
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "study/engines/attempt_log.h"
#include "study/engines/engine.h"
#include "study/sweep/round_planner.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Computes the rounds of a study by the workers of an engine, as SweepOptions::elsewhere: plans the round,
/// divides its open tasks into attempts, reads the result files of the workers, and submits again what a
/// worker that ended has left. A task that failed kMostAttempts times, by an error or because its worker
/// died, is not tried again; when all other tasks of the round are complete, the study ends with an error
/// that names it. Everything that it needs is in files, so that the same command continues a study whose
/// coordinator was killed.
class EngineRun {
 public:
  struct Reports {
    /// `waiting`: what the workers wait for; empty: they run.
    std::function<void(std::uint64_t done, std::uint64_t total, const std::string& waiting)> progress;
    std::function<bool()> stop;
    std::function<void(const std::string&)> note;  ///< what hinders the engine, how a worker died
  };
  /// `name`: of the engine, for the log. `dir`: directory of the study, absolute.
  EngineRun(std::unique_ptr<Engine> engine, const std::string& name, std::filesystem::path dir,
            Reports reports);
  ~EngineRun();

  /// Returns true when the round is complete. Throws Error(interrupted) when stopped, Error(usage) when
  /// workers refuse the study, Error(internal) for failed tasks and when no worker ever gives a result.
  bool operator()(const Round& round, ResultStore& store);

 private:
  struct Running {
    Attempt attempt;
    std::vector<std::uint64_t> tasks;  ///< numbers in the round
  };
  struct State;
  void fill(State& s);
  void submit(State& s, std::size_t most);
  Running next_attempt(State& s, std::uint64_t most);
  void read_results(State& s);
  void take_ended(State& s);
  void take_left(State& s, const Running& ended, const AttemptEnd& how);
  void log_end(State& s, const Running& ended, const AttemptEnd& how, const std::vector<std::uint64_t>& left,
               bool failed);
  void check_end(State& s, const Running& ended, const AttemptEnd& how);
  void wait(State& s);
  std::string waiting_for() const;

  std::filesystem::path dir_;
  Reports reports_;
  RoundPlanner planner_;
  AttemptLog log_;
  std::unique_ptr<Engine> engine_;
  std::uint64_t attempts_ = 0;
  std::string run_name_;         ///< of this process, in the names of its files
  std::string trouble_;          ///< last note on the engine
  std::set<std::string> noted_;  ///< how workers ended
};

}  // namespace faba
