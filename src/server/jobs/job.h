#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/toml.h"

namespace faba {

/// A job started by a page: one call of the program in a separate process, so that it can be stopped at any
/// time and cannot crash the lab.
struct Job {
  enum class State { waiting, running, done, failed, cancelled };
  int id = 0;
  std::string title = {};                     ///< "Record steer"
  std::vector<std::string> words = {};        ///< command-line arguments
  std::filesystem::path page = {}, out = {};  ///< result page and output directory, relative to the workspace
  std::string kind = {};                      ///< name of its JobKind; empty: a recording
  double work = 0;                            ///< see work_of()
  double estimate_s = 0;                      ///< run time that was estimated before the start; 0: unknown
  bool estimate_measured = false;             ///< from jobs that were complete
  State state = State::waiting;
  std::string doing = {};         ///< "simulating"
  std::uint64_t did = 0, of = 0;  ///< progress; of: total, 0 if unknown
  double seconds = 0;             ///< run time
  double ended = 0;               ///< s since 1970; 0: not ended
  std::string error = {};         ///< error message
  Json result = {};               ///< output of --json
};
/// Whether a job that has not ended names a file or folder of the workspace, or files below it, in its
/// command line or as its output.
bool job_uses(const Job& j, const std::string& path);
/// Everything except the result, which can be large.
Json job_json(const Job& j);
/// The state of a word of job_json(); failed for any other word.
Job::State job_state(const std::string& word);
/// Whether a job has ended.
inline bool is_over(const Job& j) { return j.state > Job::State::running; }

}  // namespace faba
