#include "study/sweep/sweep.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include "core/error.h"
#include "core/threads/parallel.h"

namespace faba {

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
  std::mutex counting;
  std::uint64_t done = shard_tasks - todo.size();
  Pool pool(o.threads);
  pool.run_uneven(todo.size(), [&](std::size_t i) {
    if (stopped) return;
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<double> values = round.work(todo[i]);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    store.add({key, todo[i]}, values, time.count());
    const std::lock_guard lock(counting);
    o.progress(++done, shard_tasks);
    if (o.stop()) stopped = true;
  });
  if (done < shard_tasks) throw study_stopped();
  if (of_others > 0) return false;
  o.completed(round, store);
  return true;
}

}  // namespace faba
