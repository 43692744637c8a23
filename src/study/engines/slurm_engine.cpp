// Slurm: array jobs. Needs sbatch, squeue, scancel and scontrol; no accounting database.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/monotonic.h"
#include "core/process/child.h"
#include "study/engines/engines.h"
#include "study/engines/process.h"
#include "study/engines/slurm_answers.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr unsigned kDefaultSlots = 16;
constexpr std::size_t kDefaultArray = 1001;  // MaxArraySize of Slurm, if it is not known
constexpr double kSignalBefore = 60;         // s before the time limit
constexpr double kSqueuePeriod = 1;          // s
constexpr int kEndAnswers = 2;               // of squeue that show the end of a job without a result file
constexpr const char* kNameFile = "slurm-jobs.name";  // exists while jobs can be in the queue

/// An attempt in the queue: a task of an array job.
struct SlurmTask {
  std::uint64_t id = 0;
  fs::path results, output;  ///< `output`: of Slurm and of the script before the worker
  int end_answers = 0;
};

class SlurmEngine final : public Engine {
 public:
  SlurmEngine(EngineSettings settings, WorkerCommand worker)
      : settings_(std::move(settings)),
        worker_(std::move(worker)),
        jobs_(worker_.directory / study_files::kJobs),
        name_(job_name(worker_)) {
    for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"})
      if (!program_exists(program))
        throw Error(Errc::usage, "--engine slurm",
                    fmt::format("the program {} is not found; run the command on a login node of the cluster",
                                program));
    array_ = array_size();
  }
  ~SlurmEngine() override { SlurmEngine::cancel(); }

  unsigned slots() const override {
    return settings_.workers > 0 ? unsigned(settings_.workers) : kDefaultSlots;
  }
  bool queues() const override { return true; }
  // One array job has all attempts of a submission.
  std::size_t accepts(std::size_t running, bool measured) const override {
    return std::min(Engine::accepts(running, measured), array_ - 1);
  }
  double period_s() const override { return 0.2; }
  std::string trouble() const override { return trouble_; }
  std::string waiting() const override { return waiting_; }

  bool submit(std::span<const Attempt> attempts) override {
    const std::string base = attempts.front().results.stem().string() + "-slurm";
    const fs::path list = jobs_ / (base + ".list"), script = jobs_ / (base + ".sh");
    std::string lines;
    for (const Attempt& a : attempts)
      lines += fmt::format("{}\t{}\t{}\n", a.tasks, a.results.string(), a.log.string());
    files_.insert(files_.end(), {list, script});
    write_file(list, lines);
    write_file(script, script_for(list, attempts.size()));
    write_file(jobs_ / kNameFile, name_ + "\n");
    // Paths are words of the command, because lines of #SBATCH have other rules for quotes than a shell.
    const CommandOutput answer =
        run_command({"sbatch", "--parsable", "--chdir=" + fs::current_path().string(),
                     "--output=" + output_pattern(jobs_ / base), script.string()},
                    true);
    if (answer.exit != 0) return refused(answer.out);
    accepted_ = true;
    trouble_.clear();
    std::string job = answer.out.substr(answer.out.find_last_of('\n', answer.out.size() - 2) + 1);
    job = job.substr(0, job.find_first_of(";\n"));
    for (std::size_t k = 1; k <= attempts.size(); ++k)
      tasks_[fmt::format("{}_{}", job, k)] = {attempts[k - 1].id, attempts[k - 1].results,
                                              jobs_ / fmt::format("{}-{}.out", base, k)};
    return true;
  }

  std::vector<AttemptEnd> ended() override {
    std::vector<AttemptEnd> ends;
    if (tasks_.empty() || monotonic_now() - asked_ < kSqueuePeriod) return ends;
    asked_ = monotonic_now();
    const CommandOutput answer = run_command(
        {"squeue", "--noheader", "--array", "--states=all", "--name", name_, "--Format", kSqueueFormat});
    Jobs jobs;
    for (SlurmJob& j : squeue_jobs(answer.out)) jobs.emplace(j.name, std::move(j));
    look(answer.exit == 0, jobs);
    for (auto it = tasks_.begin(); it != tasks_.end();) {
      const AttemptEnd end = end_of(it->first, it->second, answer.exit == 0, jobs);
      if (end.how.empty()) {
        ++it;
        continue;
      }
      remove_if_empty(it->second.output);
      ends.push_back(end);
      it = tasks_.erase(it);
    }
    return ends;
  }

  void cancel() override {
    const bool cancelled = tasks_.empty() || run_command({"scancel", "--name", name_}).exit == 0;
    std::error_code ec;
    for (const auto& [_, task] : tasks_) remove_if_empty(task.output);
    for (const fs::path& file : files_) fs::remove(file, ec);
    if (cancelled) fs::remove(jobs_ / kNameFile, ec);
    tasks_.clear();
    files_.clear();
    waiting_.clear();
  }

 private:
  using Jobs = std::map<std::string, SlurmJob>;

  // Of the study in its directory: the same study in another directory has other jobs.
  static std::string job_name(const WorkerCommand& worker) {
    Hash h;
    h.text(worker.study_hash);
    h.text(worker.directory.string());
    return "faba-" + h.hex();
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

  // In the path of the output, % starts a pattern; %a is the number of the task.
  static std::string output_pattern(const fs::path& base) {
    std::string pattern;
    for (const char c : base.string()) pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern + "-%a.out";
  }

  bool refused(const std::string& answer) {
    trouble_ = refusal(answer);
    if (!accepted_ && !refused_for_now(answer)) throw Error(Errc::usage, "--engine slurm", trouble_);
    return false;
  }

  static const SlurmJob* job_of(const std::string& task, const Jobs& jobs) {
    for (const std::string& name : {task, task.substr(0, task.find('_')) + "_N/A"})
      if (const auto it = jobs.find(name); it != jobs.end()) return &it->second;
    return nullptr;
  }

  // What the jobs wait for.
  void look(bool answered, const Jobs& jobs) {
    waiting_.clear();
    trouble_ = "squeue gives no answer: the controller of Slurm is not available; jobs that run continue";
    if (!answered) return;
    std::vector<SlurmJob> own;
    for (const auto& [name, _] : tasks_)
      if (const SlurmJob* j = job_of(name, jobs)) own.push_back(*j);
    waiting_ = reason_of_waiting(own);
    trouble_ = trouble_of_waiting(waiting_);
  }

  // A complete result file shows the end before squeue does. Slurm shows jobs that ended for some minutes.
  AttemptEnd end_of(const std::string& name, SlurmTask& t, bool answered, const Jobs& jobs) const {
    std::error_code ec;
    if (fs::exists(t.results, ec)) return {t.id, "results written", 0, "job " + name};
    if (!answered) return {};
    const SlurmJob* job = job_of(name, jobs);
    if (job && job->held()) {
      run_command({"scancel", name});
      return {t.id, job->reason, -1, "job " + name};
    }
    t.end_answers = job && !job->ended() ? 0 : t.end_answers + 1;
    if (t.end_answers < kEndAnswers) return {};
    AttemptEnd end{t.id, "not in the queue any more", -1, "job " + name};
    if (job) std::tie(end.how, end.exit) = end_of_job(*job, settings_.time);
    end.message = last_message(t.output);
    return end;
  }

  // The worker replaces the shell, so that the signal B: before the time limit reaches it.
  std::string script_for(const fs::path& list, std::size_t size) const {
    std::string s = fmt::format(
        "#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --ntasks=1\n#SBATCH "
        "--cpus-per-task=1\n"
        "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --time={}\n"
        "#SBATCH --signal=B:TERM@{:.0f}\n",
        name_, size, std::lround(settings_.time / 60), kSignalBefore);
    if (!settings_.partition.empty()) s += fmt::format("#SBATCH --partition={}\n", settings_.partition);
    if (!settings_.account.empty()) s += fmt::format("#SBATCH --account={}\n", settings_.account);
    for (const std::string& option : settings_.options) s += fmt::format("#SBATCH {}\n", option);
    s += fmt::format(
        "IFS=$'\\t' read -r tasks results log < <(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {})\n"
        "exec 2>> \"$log\"\n",
        shell_word(list.string()));
    for (const std::string& line : settings_.environment) s += line + "\n";
    s += "exec";
    const Attempt pattern{0, "$tasks", "$results", "$log"};
    for (const std::string& word : worker_.words(pattern))
      s += " " + (word.starts_with("$") ? "\"" + word + "\"" : shell_word(word));
    return s + "\n";
  }

  EngineSettings settings_;
  WorkerCommand worker_;
  fs::path jobs_;
  std::string name_;
  std::size_t array_ = kDefaultArray;
  std::map<std::string, SlurmTask> tasks_;  ///< by job, "17_3"
  std::vector<fs::path> files_;             ///< scripts and lists of tasks
  bool accepted_ = false;                   ///< sbatch has accepted a job
  std::string trouble_, waiting_;
  double asked_ = 0;
};

}  // namespace

std::unique_ptr<Engine> slurm_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  return std::make_unique<SlurmEngine>(settings, worker);
}

std::string cancel_slurm_jobs(const fs::path& study) {
  const fs::path file = study / study_files::kJobs / kNameFile;
  std::error_code ec;
  if (!fs::exists(file, ec)) return {};
  std::string name = read_file(file);
  name.erase(name.find_last_not_of('\n') + 1);
  if (run_command({"scancel", "--name", name}).exit != 0)
    return fmt::format(
        "Slurm jobs of an earlier command on this directory may be in the queue; cancel them on a login node "
        "by: scancel --name {}",
        shell_word(name));
  fs::remove(file, ec);
  return fmt::format("cancelled the Slurm jobs {} of an earlier command on this directory", name);
}

}  // namespace faba
