#include "study/sweep/sweep.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include <fmt/format.h>

#include "core/error.h"
#include "core/threads/parallel.h"

namespace faba {

namespace {

constexpr std::size_t kNamedFailures = 3;  // failed tasks in a message

std::string labels_text(const Round& round, std::uint64_t task) {
  std::string text;
  for (const TaskLabel& l : round.labels(task))
    if (!l.text.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", l.name, l.text);
  return text;
}

/// The tasks that failed in this process.
class Failures {
 public:
  void add(std::uint64_t task, const std::string& what, Errc code) {
    const std::lock_guard lock(adding_);
    if (failed_.empty()) code_ = code;
    failed_[task] = what;
  }
  bool hopeless(std::uint64_t done) const {
    const std::lock_guard lock(adding_);
    return done == 0 && failed_.size() >= kHopelessTasks;
  }
  void check(const Round& round) const {
    if (!failed_.empty()) throw failed_tasks(round, failed_, 1, 1, code_);
  }

 private:
  mutable std::mutex adding_;
  FailedTasks failed_;
  Errc code_ = Errc::internal;  ///< of the first
};

// Calls the work of a task. Empty when it failed.
std::optional<std::vector<double>> attempt(const Round& round, std::uint64_t task, Failures& failures) {
  try {
    return round.work(task);
  } catch (const Error& e) {
    if (e.code() == Errc::interrupted) throw;
    failures.add(task, e.what(), e.code());
  } catch (const std::exception& e) {
    failures.add(task, e.what(), Errc::internal);
  }
  return {};
}

}  // namespace

Error failed_tasks(const Round& round, const FailedTasks& failed, std::uint64_t first, int attempts,
                   Errc code) {
  std::string text;
  std::size_t named = 0;
  for (const auto& [task, what] : failed) {
    if (++named > kNamedFailures) break;
    const std::string labels = labels_text(round, task);
    text += fmt::format("{}task {}{}: {}", named > 1 ? "; " : "", first + task,
                        labels.empty() ? "" : " (" + labels + ")", what);
  }
  return {code, "",
          fmt::format("{} of {} tasks of this round failed{}: {}{}; the results of all other tasks are kept; "
                      "run the same command again to try the failed tasks again",
                      failed.size(), round.size, attempts > 1 ? fmt::format(" {} times", attempts) : "", text,
                      failed.size() > kNamedFailures ? "; ..." : "")};
}

Error study_stopped(const std::string& where) {
  return {Errc::interrupted, where,
          "stopped; completed results are kept; run the same command again to continue"};
}

std::vector<std::uint64_t> missing_tasks(const ResultStore& store, const Round& round) {
  const std::uint64_t key = store.key(round);
  std::vector<std::uint64_t> missing;
  for (std::uint64_t i = 0; i < round.size; ++i)
    if (!store.find({key, i})) missing.push_back(i);
  return missing;
}

bool sweep(ResultStore& store, const Round& round, const SweepOptions& o) {
  if (o.elsewhere) return o.elsewhere(round, store);
  const std::uint64_t key = store.key(round);
  std::vector<std::uint64_t> todo = missing_tasks(store, round);
  const std::size_t missing = todo.size();
  std::erase_if(todo, [&](std::uint64_t i) { return i % o.shard.count != o.shard.index - 1; });
  const std::uint64_t of_others = missing - todo.size();
  const std::uint64_t shard_tasks =
      round.size / o.shard.count + (round.size % o.shard.count >= o.shard.index);
  std::atomic<bool> stopped{false};
  std::atomic<std::uint64_t> computed{0};
  std::mutex counting;
  Failures failures;
  std::uint64_t done = shard_tasks - todo.size();
  Pool pool(o.threads);
  pool.run_uneven(todo.size(), [&](std::size_t i) {
    if (stopped || failures.hopeless(computed)) return;
    const auto begin = std::chrono::steady_clock::now();
    const auto values = attempt(round, todo[i], failures);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    if (values) {
      store.add({key, todo[i]}, *values, time.count());
      ++computed;
    }
    const std::lock_guard lock(counting);
    done += values.has_value();
    o.progress(done, shard_tasks);
    if (o.stop()) stopped = true;
  });
  if (stopped && done < shard_tasks) throw study_stopped();
  failures.check(round);
  if (of_others > 0) return false;
  o.completed(round, store);
  return true;
}

}  // namespace faba
