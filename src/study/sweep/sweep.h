#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "study/sweep/result_store.h"

namespace faba {

/// A piece of work of a study, on one thread and in no order.
struct Task {
  std::string key;  ///< names everything that the result depends on: task_key()
  std::function<std::vector<double>()> work;
};

/// Hash of what a task is made of, and of the program's version.
std::string task_key(const std::string& what);

/// Part `index` of `count` of the tasks, 1 <= index <= count: those whose place in the list leaves index - 1
/// when divided by count.
struct Shard {
  std::uint64_t index = 1, count = 1;
};

struct SweepOptions {
  unsigned threads = 0;  ///< 0: all of the machine's
  Shard shard = {};
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };  ///< asked between tasks
};

/// Does those tasks of the shard that `store` has no result of, on several threads, each result kept as soon
/// as it is there: a sweep that was killed goes on where it was. Returns whether the results of all tasks are
/// there now, those of other shards included. What a task throws ends the sweep and is thrown on. Throws
/// Error(interrupted) when asked to stop.
bool sweep(ResultStore& store, std::span<const Task> tasks, const SweepOptions& options);

}  // namespace faba
