#pragma once
#include <string>
#include <utility>
#include <vector>

namespace faba {

/// A task of an array job in an answer of squeue.
struct SlurmJob {
  std::string name;    ///< "17_3"; "17_N/A" for all tasks of an array that was cancelled before it started
  std::string state;   ///< "RUNNING"
  int exit = 0;        ///< exit code, or -signal
  std::string reason;  ///< "Resources"
  bool ended() const;
  /// Whether Slurm has requeued the job and does not start it again, for example because a controller that
  /// was killed has assigned the number of a job that a node still has.
  bool held() const;
};

/// Format of squeue for squeue_jobs(); it is the argument of --Format.
inline constexpr const char* kSqueueFormat =
    "ArrayJobID:20,ArrayTaskID:20,State:20,exit_code:20,ReasonList:200";
/// The jobs in an answer of squeue --noheader --array --states=all.
std::vector<SlurmJob> squeue_jobs(const std::string& answer);

/// How a job has ended, with advice, and its exit code, or -1. `time`: its time limit, s.
std::pair<std::string, int> end_of_job(const SlurmJob& job, double time);

/// Why none of the jobs that have not ended runs, in the words of squeue; empty: one runs, or there are none.
std::string reason_of_waiting(const std::vector<SlurmJob>& jobs);
/// A sentence when jobs that wait for this reason may never start; empty: they wait for free nodes.
std::string trouble_of_waiting(const std::string& reason);

/// Whether sbatch can accept the same jobs later, because it did not reach the controller of Slurm or the
/// user has too many jobs. `answer`: output of sbatch that has failed.
bool refused_for_now(const std::string& answer);
/// The output of sbatch that has failed as one line, with the key of [engine] to correct.
std::string refusal(const std::string& answer);

}  // namespace faba
