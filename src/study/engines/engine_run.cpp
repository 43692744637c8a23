#include "study/engines/engine_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "core/monotonic.h"
#include "study/engines/chunk_size.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr double kReadPeriod = 0.1;    // s, between two readings of the result files
constexpr double kTroublePeriod = 30;  // s, between two notes on what hinders the engine
constexpr double kRetryPeriod = 5;     // s, between two submissions that the engine does not accept
constexpr int kUsageExit = 2;          // of a worker that refuses the study
constexpr int kMostFruitless = 30;     // workers in succession that end without a result
// Ranges in the list of tasks of a worker: the list is one word of a command, at most 128 KiB on Linux.
constexpr std::size_t kMostRanges = 5000;

// First line of the messages of a worker.
std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::string prefix = "faba: error: ";
  return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
}

void remove_if_empty(const fs::path& log) {
  std::error_code ec;
  if (fs::file_size(log, ec) == 0 && !ec) fs::remove(log, ec);
}

}  // namespace

/// The round that is being computed.
struct EngineRun::State {
  const Round& round;
  ResultStore& store;
  PlannedRound planned;
  std::uint64_t key = 0;
  std::deque<std::uint64_t> queue = {};  ///< tasks that no worker has; they can have a result meanwhile
  std::vector<bool> open = {};           ///< by task: it has no result and has not failed
  std::uint64_t left = 0;                ///< number of open tasks
  std::map<std::uint64_t, Running> running = {};
  std::map<std::uint64_t, int> failures_before = {};  ///< failures in the result files at the start
  std::map<std::uint64_t, int> deaths = {};           ///< workers that died while they computed the task
  std::map<std::uint64_t, std::string> failed = {};
  int fruitless = 0;      ///< ends without a result in succession
  std::size_t known = 0;  ///< results in the store at the last end
  double read_at = 0, troubled_at = 0, refused_until = 0;

  void close(std::uint64_t task) {
    if (!open[task]) return;
    open[task] = false;
    --left;
  }
};

EngineRun::EngineRun(std::unique_ptr<Engine> engine, const std::string& name, fs::path dir, Reports reports)
    : dir_(std::move(dir)),
      reports_(std::move(reports)),
      planner_(dir_),
      log_(dir_ / study_files::kAttempts, name),
      engine_(std::move(engine)),
      run_name_(fmt::format("{}-{}", std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()),
                            getpid())) {
  for (const char* folder : {study_files::kResults, study_files::kJobs})
    fs::create_directories(dir_ / folder);
  log_.add(run_name_, "command started", "", "");
}

EngineRun::~EngineRun() = default;

bool EngineRun::operator()(const Round& round, ResultStore& store) {
  const std::vector<std::uint64_t> missing = missing_tasks(store, round);
  State s{round, store, planner_.plan(round, store, !missing.empty()), store.key(round)};
  if (missing.empty()) return true;
  s.queue.assign(missing.begin(), missing.end());
  s.open.resize(round.size);
  for (const std::uint64_t task : missing) s.open[task] = true;
  s.left = missing.size();
  for (const auto& [task, f] : store.failures(s.key)) s.failures_before[task] = f.attempts;
  s.known = store.size();
  while (s.left > 0) {
    if (reports_.stop()) {
      engine_->cancel();
      log_.add(run_name_, "command stopped", "", "");
      throw study_stopped();
    }
    fill(s);
    wait(s);
    take_ended(s);
    read_results(s);
    reports_.progress(round.size - s.left - s.failed.size(), round.size);
  }
  engine_->cancel();  // attempts whose tasks were completed by others
  if (!s.failed.empty()) throw failed_tasks(round, s.failed, s.planned.first, kMostAttempts);
  return true;
}

// Gives work to free workers.
void EngineRun::fill(State& s) {
  while (!s.queue.empty() && !s.open[s.queue.front()]) s.queue.pop_front();
  if (s.queue.empty() || monotonic_now() < s.refused_until) return;
  const bool measured = s.store.seconds_per_task(s.key).has_value();
  if (const std::size_t most = engine_->accepts(s.running.size(), measured); most > 0) submit(s, most);
}

// At most `most` attempts, of equal size.
void EngineRun::submit(State& s, std::size_t most) {
  std::vector<Running> next;
  const std::uint64_t open = s.queue.size(), workers = std::min<std::size_t>(most, engine_->slots());
  const ChunkSize size{open, engine_->slots(), s.store.seconds_per_task(s.key), engine_->queues()};
  const std::uint64_t each = std::min(size.tasks(), (open + workers - 1) / workers);  // work for all of them
  while (!s.queue.empty() && next.size() < most) {
    Running r = next_attempt(s, each);
    if (!r.tasks.empty()) next.push_back(std::move(r));
  }
  if (next.empty()) return;
  std::vector<Attempt> attempts;
  for (const Running& r : next) attempts.push_back(r.attempt);
  if (!engine_->submit(attempts)) {
    s.refused_until = monotonic_now() + kRetryPeriod;
    for (auto it = next.rbegin(); it != next.rend(); ++it)
      s.queue.insert(s.queue.begin(), it->tasks.begin(), it->tasks.end());
    return;
  }
  for (Running& r : next) {
    log_.add(r.attempt.results.stem().string(), "submitted", r.attempt.tasks, "");
    s.running.emplace(r.attempt.id, std::move(r));
  }
}

// Takes at most `most` tasks from the queue.
EngineRun::Running EngineRun::next_attempt(State& s, std::uint64_t most) {
  Running r;
  std::vector<std::uint64_t> numbers;
  for (std::size_t ranges = 0; !s.queue.empty() && r.tasks.size() < most; s.queue.pop_front()) {
    const std::uint64_t task = s.queue.front();
    if (!s.open[task]) continue;
    if ((r.tasks.empty() || task != r.tasks.back() + 1) && ++ranges > kMostRanges) break;
    r.tasks.push_back(task);
    numbers.push_back(s.planned.first + task);
  }
  const std::string name = fmt::format("{}-{}", run_name_, ++attempts_);
  r.attempt = {attempts_, number_list(numbers), dir_ / study_files::kResults / (name + ".results"),
               dir_ / study_files::kJobs / (name + ".log")};
  return r;
}

void EngineRun::read_results(State& s) {
  if (monotonic_now() - s.read_at < kReadPeriod) return;
  s.read_at = monotonic_now();
  s.store.read_new([&](TaskId id) {
    if (id.round == s.key && id.task < s.open.size()) s.close(id.task);
  });
}

void EngineRun::take_ended(State& s) {
  const std::vector<AttemptEnd> ends = engine_->ended();
  if (ends.empty()) return;
  s.read_at = 0;
  read_results(s);
  for (const AttemptEnd& end : ends) {
    const auto it = s.running.find(end.id);
    if (it == s.running.end()) continue;
    const Running ended = std::move(it->second);
    s.running.erase(it);
    take_left(s, ended, end);
    remove_if_empty(ended.attempt.log);
  }
}

// Submits again what a worker that ended has left.
void EngineRun::take_left(State& s, const Running& ended, const AttemptEnd& how) {
  const std::string name = ended.attempt.results.stem().string(), message = first_line(ended.attempt.log);
  std::vector<std::uint64_t> left, numbers;
  const auto failures = s.store.failures(s.key);
  bool failed = false;           // a task, with a recorded reason
  bool charged = how.exit == 0;  // the first task without a record is the one that the worker computed
  for (const std::uint64_t task : ended.tasks) {
    if (!s.open[task]) continue;
    const auto recorded = failures.find(task);
    const int failures_now =
        recorded == failures.end() ? 0 : recorded->second.attempts - s.failures_before[task];
    failed = failed || failures_now > 0;
    if (failures_now == 0 && !charged) {
      ++s.deaths[task];
      charged = true;
    }
    if (failures_now + s.deaths[task] >= kMostAttempts) {
      s.failed[task] = failures_now > 0 ? recorded->second.what
                                        : fmt::format("the worker ended with {}{}{}", how.how,
                                                      message.empty() ? "" : ": ", message);
      s.close(task);
      log_.add(name, "task failed", std::to_string(s.planned.first + task), s.failed[task]);
      continue;
    }
    left.push_back(task);
    numbers.push_back(s.planned.first + task);
  }
  s.queue.insert(s.queue.begin(), left.begin(), left.end());
  log_.add(name, left.empty() ? "complete" : "left tasks", number_list(numbers),
           message.empty() ? how.how : how.how + ": " + message);
  const bool fruitful = s.store.size() > s.known || failed || (left.empty() && how.exit == 0);
  s.fruitless = fruitful ? 0 : s.fruitless + 1;
  s.known = s.store.size();
  if (how.exit == kUsageExit) {
    engine_->cancel();
    throw Error(Errc::usage, "", "a worker refused the study: " + (message.empty() ? how.how : message));
  }
  if (s.fruitless >= kMostFruitless) {
    engine_->cancel();
    throw Error(
        Errc::internal, ended.attempt.log.string(),
        fmt::format("the last {} workers ended without a result ({}{}{}); correct the settings of the "
                    "engine and run the same command again",
                    s.fruitless, how.how, message.empty() ? "" : ": ", message));
  }
}

void EngineRun::wait(State& s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(engine_->period_s()));
  const std::string trouble = engine_->trouble();
  const double now = monotonic_now();
  if (trouble.empty()) s.troubled_at = now;
  if (now - s.troubled_at < kTroublePeriod) return;
  s.troubled_at = now;
  log_.add(run_name_, "engine", "", trouble);
  reports_.note(trouble);
}

}  // namespace faba
