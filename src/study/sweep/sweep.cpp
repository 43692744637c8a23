#include "study/sweep/sweep.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/error.h"
#include "core/hash.h"
#include "core/threads/parallel.h"

namespace faba {
namespace {

// Tasks allocate and free memory for frames thousands of times. Returning it to the system each time would
// cost more than the tasks, because the system clears every page.
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace

std::string task_key(const std::string& what) {
  Hash h;
  h.text(FABA_VERSION);
  h.text(what);
  return h.hex();
}

bool sweep(ResultStore& store, std::span<const Task> tasks, const SweepOptions& o) {
  keep_freed_memory();
  std::vector<const Task*> todo;
  std::uint64_t shard_tasks = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (i % o.shard.count != o.shard.index - 1) continue;
    ++shard_tasks;
    if (!store.find(tasks[i].key)) todo.push_back(&tasks[i]);
  }
  std::atomic<bool> stopped{false};
  std::mutex storing;
  std::uint64_t done = shard_tasks - todo.size();
  Pool pool(o.threads);
  pool.run_uneven(todo.size(), [&](std::size_t i) {
    if (stopped) return;
    const std::vector<double> values = todo[i]->work();
    const std::lock_guard lock(storing);
    store.add(todo[i]->key, values);
    o.progress(++done, shard_tasks);
    if (o.stop()) stopped = true;
  });
  if (done < shard_tasks)
    throw Error(Errc::interrupted, "",
                "stopped; completed results are kept; run the same command again to continue");
  return std::all_of(tasks.begin(), tasks.end(), [&](const Task& t) { return store.find(t.key) != nullptr; });
}

}  // namespace faba
