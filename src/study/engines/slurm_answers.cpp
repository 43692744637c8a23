#include "study/engines/slurm_answers.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "study/engines/process.h"

namespace faba {
namespace {

// States from which Slurm starts no job again (man squeue, "JOB STATE CODES").
constexpr std::array<std::string_view, 9> kEnded{"BOOT_FAIL", "CANCELLED",     "COMPLETED",
                                                 "DEADLINE",  "FAILED",        "NODE_FAIL",
                                                 "PREEMPTED", "OUT_OF_MEMORY", "TIMEOUT"};
// Parts of the messages of sbatch about the connection to the controller, about Munge (authentication), and
// about limits on the number of jobs. Any other message is permanent.
constexpr std::array<std::string_view, 13> kForNow{"Unable to contact",
                                                   "timed out",
                                                   "standby",
                                                   "temporarily",
                                                   "Connection",
                                                   "connection",
                                                   "Zero Bytes",
                                                   "Protocol",
                                                   "Transport",
                                                   "unge",
                                                   "Job violates accounting/QOS policy",
                                                   "SubmitJob",
                                                   "Unable to resolve"};

bool contains(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

// Wait status as a number; later versions of Slurm may write EXIT:SIGNAL.
int exit_of(const std::string& word) {
  int status = 0, signal = 0;
  if (std::sscanf(word.c_str(), "%d:%d", &status, &signal) == 2) return signal != 0 ? -signal : status;
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

bool SlurmJob::ended() const { return std::ranges::find(kEnded, state) != kEnded.end(); }

bool SlurmJob::held() const { return state == "PENDING" && reason == "launch failed requeued held"; }

std::vector<SlurmJob> squeue_jobs(const std::string& answer) {
  std::vector<SlurmJob> jobs;
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string array, task, exit;
    SlurmJob j;
    if (!(words >> array >> task >> j.state >> exit)) continue;
    j.name = array.append("_").append(task);
    j.exit = exit_of(exit);
    std::getline(words >> std::ws, j.reason);
    j.reason.erase(j.reason.find_last_not_of(' ') + 1);
    if (j.reason.starts_with("(") && j.reason.ends_with(")"))
      j.reason = j.reason.substr(1, j.reason.size() - 2);
    jobs.push_back(std::move(j));
  }
  return jobs;
}

std::pair<std::string, int> end_of_job(const SlurmJob& job, double time) {
  if (job.state == "TIMEOUT")
    return {
        fmt::format("reached its time limit (time of [engine] is {:g} min); set a longer time", time / 60),
        -1};
  if (job.state == "OUT_OF_MEMORY")
    return {"exceeded its memory limit; set more in options of [engine], such as \"--mem=4G\"", -1};
  if (job.state == "FAILED" || job.state == "COMPLETED") return {end_text(job.exit), std::max(-1, job.exit)};
  return {"ended as " + job.state, -1};
}

std::string reason_of_waiting(const std::vector<SlurmJob>& jobs) {
  std::string reason;
  for (const SlurmJob& j : jobs) {
    if (j.ended()) continue;
    if (j.state != "PENDING") return {};
    if (reason.empty() || reason == "None") reason = j.reason.empty() ? "None" : j.reason;
  }
  return reason;
}

std::string trouble_of_waiting(const std::string& reason) {
  for (const std::string_view harmless : {"", "None", "Resources", "Priority", "BeginTime", "Cleaning"})
    if (reason == harmless) return {};
  std::string text = "all jobs of Slurm wait: " + reason;
  if (reason == "PartitionTimeLimit" || reason == "PartitionConfig")
    text +=
        "; the jobs may exceed the limits of the partition: compare time, partition and options of [engine] "
        "with the output of `scontrol show partition`";
  else if (reason.starts_with("Assoc") || reason.starts_with("QOS") || reason.starts_with("Invalid"))
    text += "; compare account, time and options of [engine] with the limits of your account";
  return text;
}

bool refused_for_now(const std::string& answer) {
  return std::ranges::any_of(kForNow, [&](std::string_view part) { return contains(answer, part); });
}

std::string refusal(const std::string& answer) {
  std::string text;
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    for (const std::string_view prefix : {"sbatch: ", "error: "})
      if (line.starts_with(prefix)) line.erase(0, prefix.size());
    if (!line.empty()) text += (text.empty() ? "" : "; ") + line;
  }
  if (contains(text, "configuration source") || contains(text, "slurm.conf"))
    return fmt::format("sbatch finds no cluster: {}; run the command on a login node of the cluster", text);
  const std::string key = contains(text, "ccount")      ? "account"
                          : contains(text, "partition") ? "partition"
                          : contains(text, "time")      ? "time"
                                                        : "options";
  return fmt::format("sbatch refuses the jobs: {}; correct {} in [engine]", text, key);
}

}  // namespace faba
