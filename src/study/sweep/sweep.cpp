#include "study/sweep/sweep.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace faba {
namespace {

// Tasks take and give back memory for pictures by the thousand. Given back to the system each time, that
// costs more than the work done in it: pages come cleared, one by one.
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
  std::uint64_t mine = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (i % o.shard.count != o.shard.index - 1) continue;
    ++mine;
    if (!store.find(tasks[i].key)) todo.push_back(&tasks[i]);
  }
  std::atomic<std::size_t> next{0};
  std::atomic<bool> over{false};
  std::mutex keeping;
  std::uint64_t done = mine - todo.size();
  Pool pool(o.threads);
  // Tasks are of different length: each thread takes the next one when it is free.
  if (!todo.empty())
    pool.run(pool.threads(), [&](std::size_t) {
      for (std::size_t i; !over && (i = next++) < todo.size();) {
        try {
          const std::vector<double> values = todo[i]->work();
          const std::lock_guard lock(keeping);
          store.add(todo[i]->key, values);
          o.progress(++done, mine);
          if (o.stop()) over = true;
        } catch (...) {
          over = true;
          throw;
        }
      }
    });
  if (done < mine) throw Error(Errc::interrupted, "", "stopped; what is done is kept");
  return std::all_of(tasks.begin(), tasks.end(), [&](const Task& t) { return store.find(t.key) != nullptr; });
}

}  // namespace faba
