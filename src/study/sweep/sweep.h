#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "study/sweep/result_store.h"

namespace faba {

/// A task of a study; it runs on one thread, in any order.
struct Task {
  std::string key;  ///< hash of everything that the result depends on: task_key()
  std::function<std::vector<double>()> work;
};

/// Hash of the description of a task and the version of the program.
std::string task_key(const std::string& what);

/// Part `index` of `count` of the tasks, 1 <= index <= count: those whose position in the list modulo count
/// is index - 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
};

struct SweepOptions {
  unsigned threads = 0;  ///< 0: all processors
  Shard shard = {};
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };  ///< checked between tasks
};

/// Runs those tasks of the shard that have no result in `store`, on several threads. Each result is stored
/// immediately, so that a killed sweep can be resumed. Returns whether the results of all tasks are
/// available, including those of other shards. An exception of a task ends the sweep and is rethrown. Throws
/// Error(interrupted) when stopped.
bool sweep(ResultStore& store, std::span<const Task> tasks, const SweepOptions& options);

}  // namespace faba
