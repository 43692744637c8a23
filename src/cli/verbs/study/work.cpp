#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/progress.h"
#include "cli/study_job.h"
#include "core/counted.h"
#include "core/error.h"
#include "core/threads/parallel.h"
#include "study/sweep/round_file.h"
#include "study/sweep/round_planner.h"

namespace faba::cli {
namespace {

struct WorkVerb {
  std::filesystem::path dir, results;
  std::string tasks;
  unsigned threads = 1;
  pid_t parent = 0;
};

// The system kills this process when the process that started it ends, because its results would not be
// used.
void end_with_parent(pid_t parent) {
  if (parent == 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _Exit(int(Errc::interrupted));
}

// A file that no other attempt uses: a scheduler can start a job again with the same command.
std::filesystem::path free_file(const std::filesystem::path& results) {
  const auto used = [](const std::filesystem::path& p) {
    return std::filesystem::exists(p) || std::filesystem::exists(partial_name(p));
  };
  std::filesystem::path file = results;
  for (int k = 2; used(file); ++k)
    file = results.parent_path() /
           fmt::format("{}-{}{}", results.stem().string(), k, results.extension().string());
  return file;
}

/// The tasks of a command: rounds, each with numbers of tasks in it.
struct Work {
  Round round;
  std::vector<std::uint64_t> tasks;
};

std::vector<Work> planned_work(const WorkVerb& v, const StudyJob& job) {
  const std::vector<std::uint64_t> numbers = numbers_in(v.tasks);
  std::vector<Work> all;
  for (std::size_t i = 0; i < numbers.size();) {
    const PlannedRound planned = planned_round(v.dir, job.hash(), numbers[i]);
    Work& work = all.emplace_back();
    work.round = job.round(v.dir / study_files::kMeasured, planned.description);
    if (work.round.size != planned.size || work.round.description != planned.description)
      throw Error(Errc::usage, v.dir.string(), "the round was planned by another version of the program");
    for (; i < numbers.size() && planned.contains(numbers[i]); ++i)
      work.tasks.push_back(numbers[i] - planned.first);
  }
  return all;
}

/// Computes tasks and stores each result, or the reason why it failed.
class Worker {
 public:
  Worker(ResultFile& file, Progress& bar, std::uint64_t total) : file_(file), bar_(bar), total_(total) {}

  void run(const Work& work, std::uint64_t key, unsigned threads) {
    Pool pool(threads);
    pool.run_uneven(work.tasks.size(), [&](std::size_t i) {
      if (!stop_requested()) compute(work.round, {key, work.tasks[i]});
    });
  }
  std::uint64_t done() const { return done_; }
  std::uint64_t failed() const { return failed_; }

 private:
  void compute(const Round& round, TaskId id) {
    const auto begin = std::chrono::steady_clock::now();
    TaskResult result{id, 0, {}, {}};
    std::vector<double> values;
    std::string failure;
    try {
      values = round.work(id.task);
      result.values = values;
    } catch (const Error& e) {
      if (e.code() == Errc::interrupted) return;
      failure = e.what();
    } catch (const std::exception& e) {
      failure = e.what();
    }
    const std::lock_guard lock(storing_);
    result.failure = failure;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    file_.add(result);
    failed_ += !failure.empty();
    bar_.update(++done_, total_);
  }

  ResultFile& file_;
  Progress& bar_;
  std::uint64_t total_, done_ = 0, failed_ = 0;
  std::mutex storing_;
};

int study_work(WorkVerb v, const Common& c) {
  end_with_parent(v.parent);
  (void)stop_requested();
  if (v.results.extension() != ".results")
    throw Error(Errc::usage, "--results",
                fmt::format("{}: the name must end in .results", v.results.string()));
  const StoredStudy stored = stored_study(v.dir);
  if (!stored.source.folder.empty()) {  // in which the command of the study found its videos
    const std::filesystem::path folder = std::filesystem::absolute(stored.source.folder);
    v.dir = std::filesystem::absolute(v.dir);
    v.results = std::filesystem::absolute(v.results);
    std::filesystem::current_path(folder);
  }
  const auto job = study_job(stored.source, false);
  if (job->hash() != stored.hash)
    throw Error(Errc::usage, stored.source.file.string(),
                fmt::format("differs from the study that was planned in {}", v.dir.string()));
  const std::vector<Work> all = planned_work(v, *job);
  std::uint64_t total = 0;
  for (const Work& work : all) total += work.tasks.size();
  ResultFile file(free_file(v.results), job->hash());
  Progress bar("tasks", !c.quiet && !c.json);
  Worker worker(file, bar, total);
  for (const Work& work : all) worker.run(work, round_key(job->hash(), work.round), v.threads);
  bar.clear();
  file.complete();
  if (worker.done() < total)
    throw Error(Errc::interrupted, "", fmt::format("stopped after {} of {} tasks", worker.done(), total));
  if (c.json)
    fmt::print("{}\n",
               nlohmann::ordered_json{
                   {"results", file.path().string()}, {"tasks", worker.done()}, {"failed", worker.failed()}}
                   .dump());
  else if (!c.quiet)
    fmt::print("{}: {}, {} failed\n", file.path().string(), counted(worker.done(), "task"), worker.failed());
  return 0;
}

}  // namespace

void add_study_work(CLI::App& study, CommandLine& line) {
  const auto o = std::make_shared<WorkVerb>();
  CLI::App* v = verb(study, line, "work", "Compute tasks of a study that is planned in a directory",
                     "  faba study work runs/mine --tasks 1-100 --results runs/mine/results/a.results\n"
                     "  faba study work runs/mine --tasks 3,17-20 --results b.results --threads 4");
  v->add_option("dir", o->dir, "Directory of the study")->required();
  v->add_option("--tasks", o->tasks, "Numbers of the tasks, such as 1-20,45")->required()->check(not_empty);
  v->add_option(
       "--results", o->results,
       "Result file to write; put it into the folder results of the directory, or give it to collect")
      ->required()
      ->type_name("FILE.results");
  v->add_option("--threads", o->threads, "Number of threads; default: 1. Does not change the result")
      ->check(integers(1, 1024));
  v->add_option("--parent", o->parent, "End when the process with this number ends")->group("");
  v->callback([o, &line] { line.code = study_work(*o, line.common); });
}

}  // namespace faba::cli
