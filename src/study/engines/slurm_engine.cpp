// Slurm: array jobs. Needs sbatch, squeue, scancel and scontrol; no accounting database.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "core/child.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/monotonic.h"
#include "study/engines/engines.h"
#include "study/engines/process.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr unsigned kDefaultSlots = 16;
constexpr std::size_t kDefaultArray = 1001;  // MaxArraySize of Slurm, if it is not known
constexpr double kSignalBefore = 60;         // s before the time limit
constexpr double kSqueuePeriod = 1;          // s
constexpr int kAbsences = 2;                 // answers of squeue without a job that has ended

/// An attempt in the queue: a task of an array job.
struct SlurmTask {
  std::uint64_t id = 0;
  fs::path results;
  int absences = 0;
};

// Reason of a job that Slurm requeues and does not start again, for example when a controller that was killed
// has assigned the number of a job that a node still has.
constexpr std::string_view kLaunchFailed = "launch failed requeued held";

class SlurmEngine final : public Engine {
 public:
  SlurmEngine(EngineSettings settings, WorkerCommand worker)
      : settings_(std::move(settings)), worker_(std::move(worker)), name_(job_name(worker_)) {
    for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"})
      if (!program_exists(program))
        throw Error(Errc::usage, "--engine slurm",
                    fmt::format("the program {} is not found; run the command on a login node of the cluster",
                                program));
    array_ = array_size();
    // Jobs of an earlier call of this command: its coordinator was killed.
    run_command({"scancel", "--name", name_});
  }
  ~SlurmEngine() override { SlurmEngine::cancel(); }

  unsigned slots() const override {
    return settings_.workers > 0 ? unsigned(settings_.workers) : kDefaultSlots;
  }
  bool queues() const override { return true; }
  double period_s() const override { return 0.2; }
  std::string trouble() const override { return trouble_; }

  bool submit(std::span<const Attempt> attempts) override {
    while (!attempts.empty()) {
      const std::size_t n = std::min(attempts.size(), array_ - 1);
      if (!submit_array(attempts.first(n))) return false;
      attempts = attempts.subspan(n);
    }
    return true;
  }

  std::vector<AttemptEnd> ended() override {
    std::vector<AttemptEnd> ends;
    if (tasks_.empty() || monotonic_now() - asked_ < kSqueuePeriod) return ends;
    asked_ = monotonic_now();
    const CommandOutput answer =
        run_command({"squeue", "--noheader", "--array", "--name", name_, "--format", "%F_%K %T %r"});
    if (answer.exit != 0)
      trouble_ = "squeue gives no answer: the controller of Slurm is not available; jobs that run continue";
    else
      trouble_ = held(answer.out);
    for (auto it = tasks_.begin(); it != tasks_.end();) {
      const AttemptEnd end = end_of(it->first, it->second, answer);
      if (end.how.empty()) {
        ++it;
        continue;
      }
      ends.push_back(end);
      it = tasks_.erase(it);
    }
    return ends;
  }

  void cancel() override {
    if (!tasks_.empty()) run_command({"scancel", "--name", name_});
    tasks_.clear();
  }

 private:
  // Of the study in its directory: the same study in another directory has other jobs.
  static std::string job_name(const WorkerCommand& worker) {
    Hash h;
    h.text(worker.study_hash);
    h.text(worker.directory.string());
    return "faba-" + h.hex();
  }

  // A complete result file shows the end before squeue does.
  static AttemptEnd end_of(const std::string& job, SlurmTask& t, const CommandOutput& squeue) {
    std::error_code ec;
    if (fs::exists(t.results, ec)) return {t.id, fmt::format("job {}: exit code 0", job), 0};
    if (squeue.exit != 0) return {};
    const std::string jobs = "\n" + squeue.out;
    const auto at = jobs.find("\n" + job + " ");
    const bool queued = at != std::string::npos;
    if (queued && jobs.substr(at + 1, jobs.find('\n', at + 1) - at - 1).ends_with(kLaunchFailed)) {
      run_command({"scancel", job});
      return {t.id, fmt::format("job {}: {}", job, kLaunchFailed), -1};
    }
    t.absences = queued ? 0 : t.absences + 1;
    if (t.absences < kAbsences) return {};
    return {t.id, fmt::format("job {}: not in the queue any more", job), -1};
  }

  // A sentence when all jobs wait for an administrator; empty otherwise.
  static std::string held(const std::string& squeue) {
    std::istringstream lines(squeue);
    std::string line, reason;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string job, state;
      words >> job >> state;
      if (state != "PENDING") return {};
      std::getline(words >> std::ws, reason);
    }
    if (reason.empty() || reason == "Resources" || reason == "Priority" || reason == "None") return {};
    return fmt::format("all jobs of Slurm wait: {}", reason);
  }

  static std::size_t array_size() {
    const CommandOutput config = run_command({"scontrol", "show", "config"});
    const auto at = config.out.find("MaxArraySize");
    if (at == std::string::npos) return kDefaultArray;
    const auto digits = config.out.find_first_of("0123456789", at);
    std::size_t size = 0;
    if (digits == std::string::npos) return kDefaultArray;
    std::from_chars(config.out.data() + digits, config.out.data() + config.out.size(), size);
    return std::max<std::size_t>(2, size);
  }

  bool submit_array(std::span<const Attempt> attempts) {
    const fs::path base = worker_.directory / study_files::kJobs / attempts.front().results.stem();
    const fs::path list = base.string() + "-slurm.list", script = base.string() + "-slurm.sh";
    std::string lines;
    for (const Attempt& a : attempts)
      lines += fmt::format("{}\t{}\t{}\n", a.tasks, a.results.string(), a.log.string());
    write_file(list, lines);
    write_file(script, script_for(list, attempts.size()));
    const CommandOutput answer = run_command({"sbatch", "--parsable", script.string()}, true);
    if (answer.exit != 0) {
      trouble_ = "sbatch refuses the jobs: " + answer.out.substr(0, answer.out.find('\n'));
      return false;
    }
    trouble_.clear();
    std::string job = answer.out.substr(answer.out.find_last_of('\n', answer.out.size() - 2) + 1);
    job = job.substr(0, job.find_first_of(";\n"));
    for (std::size_t k = 0; k < attempts.size(); ++k)
      tasks_[fmt::format("{}_{}", job, k + 1)] = {attempts[k].id, attempts[k].results};
    return true;
  }

  std::string script_for(const fs::path& list, std::size_t size) const {
    const auto minutes = std::max(1L, std::lround(settings_.time / 60));
    std::string s = fmt::format(
        "#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --ntasks=1\n#SBATCH "
        "--cpus-per-task=1\n"
        "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --output=/dev/null\n#SBATCH --time={}\n"
        "#SBATCH --signal=TERM@{:.0f}\n#SBATCH --chdir={}\n",
        name_, size, minutes, kSignalBefore, fs::current_path().string());
    if (!settings_.partition.empty()) s += fmt::format("#SBATCH --partition={}\n", settings_.partition);
    if (!settings_.account.empty()) s += fmt::format("#SBATCH --account={}\n", settings_.account);
    for (const std::string& option : settings_.options) s += fmt::format("#SBATCH {}\n", option);
    for (const std::string& line : settings_.environment) s += line + "\n";
    s += fmt::format(
        "IFS=$'\\t' read -r tasks results log < <(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {})\n"
        "exec",
        shell_word(list.string()));
    const Attempt pattern{0, "$tasks", "$results", "$log"};
    for (const std::string& word : worker_.words(pattern))
      s += " " + (word.starts_with("$") ? "\"" + word + "\"" : shell_word(word));
    return s + " 2>> \"$log\"\n";
  }

  EngineSettings settings_;
  WorkerCommand worker_;
  std::string name_;
  std::size_t array_ = kDefaultArray;
  std::map<std::string, SlurmTask> tasks_;  ///< by job, "17_3"
  std::string trouble_;
  double asked_ = 0;
};

}  // namespace

std::unique_ptr<Engine> slurm_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  return std::make_unique<SlurmEngine>(settings, worker);
}

}  // namespace faba
