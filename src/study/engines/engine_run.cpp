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
#include "study/engines/process.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr double kReadPeriod = 0.1;    // s, between two readings of the result files
constexpr double kTroubleTime = 5;     // s, of trouble before it is reported
constexpr double kMeasuringTime = 30;  // s, of workers without a result: tasks take longer
constexpr double kRetryPeriod = 5;     // s, between two submissions that the engine does not accept
constexpr int kUsageExit = 2;          // of a worker that refuses the study
constexpr int kMostFruitless = 30;     // workers in succession that end without a result
constexpr std::size_t kMostNotes = 5;  // about different ends of workers
// Ranges in the list of tasks of a worker: the list is one word of a command, at most 128 KiB on Linux.
constexpr std::size_t kMostRanges = 5000;

// The error of a worker, or the first line of its messages, such as those of the environment lines.
std::string message_in(const fs::path& log) {
  std::ifstream in(log);
  const std::string prefix = "faba: error: ";
  std::string first;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(prefix)) return line.substr(prefix.size());
    if (first.empty()) first = line;
  }
  return first;
}

// A worker creates its result file before its first task.
bool started(const Attempt& a) {
  std::error_code ec;
  return fs::exists(a.results, ec) || fs::exists(partial_name(a.results), ec);
}

std::string joined(const std::string& how, const std::string& message) {
  return message.empty() ? how : how + ": " + message;
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
  double read_at = 0, untroubled_at = 0, refused_until = 0;
  double checked_at = 0, worked = 0;  ///< s; `worked`: time with running workers, before the first result

  // Time of a task. Without a result it is unknown, or longer than the time for which workers run.
  std::optional<double> seconds_per_task() const {
    const auto seconds = store.seconds_per_task(key);
    return seconds || worked < kMeasuringTime ? seconds : worked;
  }

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
    reports_.progress(round.size - s.left - s.failed.size(), round.size, waiting_for());
  }
  engine_->cancel();
  for (const auto& [_, r] : s.running) {
    log_.add(r.attempt.results.stem().string(), "complete", "",
             joined("all results of the round were read", message_in(r.attempt.log)));
    remove_if_empty(r.attempt.log);
  }
  if (!s.failed.empty()) throw failed_tasks(round, s.failed, s.planned.first, kMostAttempts);
  return true;
}

// Gives work to free workers.
void EngineRun::fill(State& s) {
  while (!s.queue.empty() && !s.open[s.queue.front()]) s.queue.pop_front();
  if (s.queue.empty() || monotonic_now() < s.refused_until) return;
  const bool measured = s.seconds_per_task().has_value();
  if (const std::size_t most = engine_->accepts(s.running.size(), measured); most > 0) submit(s, most);
}

// At most `most` attempts, of equal size.
void EngineRun::submit(State& s, std::size_t most) {
  std::vector<Running> next;
  const ChunkSize size{s.queue.size(), engine_->slots(), s.seconds_per_task(), engine_->queues()};
  const std::uint64_t each = size.tasks();
  while (!s.queue.empty() && next.size() < most) {
    Running r = next_attempt(s, each);
    if (!r.tasks.empty()) next.push_back(std::move(r));
  }
  if (next.empty()) return;
  std::vector<Attempt> attempts;
  attempts.reserve(next.size());
  for (const Running& r : next) attempts.push_back(r.attempt);
  if (!engine_->submit(attempts)) {
    s.refused_until = monotonic_now() + kRetryPeriod;
    attempts_ -= next.size();  // the next try has the same files
    std::vector<std::uint64_t> again;
    for (const Running& r : next) again.insert(again.end(), r.tasks.begin(), r.tasks.end());
    s.queue.insert(s.queue.begin(), again.begin(), again.end());
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
    remove_if_empty(ended.attempt.log);
    take_left(s, ended, end);
  }
}

// Submits again what a worker that ended has left.
void EngineRun::take_left(State& s, const Running& ended, const AttemptEnd& how) {
  const std::string name = ended.attempt.results.stem().string(), message = message_in(ended.attempt.log);
  std::vector<std::uint64_t> left;
  const auto failures = s.store.failures(s.key);
  bool failed = false;  // a task, with a recorded reason
  // The first task without a record is the one that the worker computed, if it computed any.
  bool charged = how.exit == 0 || !started(ended.attempt);
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
    const int times = failures_now + s.deaths[task];
    const std::string reason =
        failures_now > 0 ? recorded->second.what : "the worker ended with " + joined(how.text(), message);
    const bool given_up = times >= kMostAttempts;
    if (failures_now > 0 || given_up)
      log_.add(name, given_up ? "task failed" : "task error", std::to_string(s.planned.first + task), reason);
    if (given_up) {
      s.failed[task] = reason;
      s.close(task);
    } else {
      left.push_back(task);
    }
  }
  s.queue.insert(s.queue.begin(), left.begin(), left.end());
  log_end(s, ended, how, left, failed);
  const bool fruitful = s.store.size() > s.known || failed || (left.empty() && how.exit == 0);
  s.fruitless = fruitful ? 0 : s.fruitless + 1;
  s.known = s.store.size();
  check_end(s, ended, how);
}

void EngineRun::log_end(State& s, const Running& ended, const AttemptEnd& how,
                        const std::vector<std::uint64_t>& left, bool failed) {
  const std::string name = ended.attempt.results.stem().string(), message = message_in(ended.attempt.log);
  std::vector<std::uint64_t> numbers;
  numbers.reserve(left.size());
  for (const std::uint64_t task : left) numbers.push_back(s.planned.first + task);
  const char* event = !left.empty() ? "left tasks" : failed || how.exit != 0 ? "ended" : "complete";
  log_.add(name, event, number_list(numbers), joined(how.text(), message));
  const bool normal = how.exit == 0 && message.empty();
  if (normal || noted_.size() >= kMostNotes || !noted_.insert(how.how).second) return;
  if (how.exit == 0 && left.empty())
    reports_.note(fmt::format("attempt {} computed its tasks, with the message: {}", name, message));
  else
    reports_.note(fmt::format("attempt {} ended with {}{}", name, joined(how.text(), message),
                              left.empty() ? "" : "; its tasks are submitted again"));
}

// Throws when other workers would end in the same way.
void EngineRun::check_end(State& s, const Running& ended, const AttemptEnd& how) {
  const std::string message = message_in(ended.attempt.log);
  if (how.exit == kUsageExit) {
    engine_->cancel();
    throw Error(Errc::usage, "", "a worker refused the study: " + (message.empty() ? how.text() : message));
  }
  if (s.fruitless < kMostFruitless) return;
  engine_->cancel();
  throw Error(
      Errc::internal, message.empty() ? "" : ended.attempt.log.string(),
      fmt::format("the last {} workers ended without a result ({}); correct the settings of the "
                  "engine and run the same command again. {} lists how they ended",
                  s.fruitless, joined(how.text(), message), (dir_ / study_files::kAttempts).string()));
}

void EngineRun::wait(State& s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(engine_->period_s()));
  const std::string trouble = engine_->trouble();
  const double now = monotonic_now();
  if (!s.running.empty() && waiting_for().empty() && s.checked_at > 0) s.worked += now - s.checked_at;
  s.checked_at = now;
  if (trouble.empty()) {
    s.untroubled_at = now;
    trouble_.clear();  // the same trouble is reported again when it comes back
  }
  if (trouble == trouble_ || now - s.untroubled_at < kTroubleTime) return;
  trouble_ = trouble;
  log_.add(run_name_, "engine", "", trouble);
  reports_.note(trouble);
}

// Text for the progress bar; empty while workers run.
std::string EngineRun::waiting_for() const {
  const std::string reason = engine_->waiting();
  return reason.empty() ? engine_->trouble() : "waiting for the queue: " + reason;
}

}  // namespace faba
