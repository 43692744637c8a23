#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "study/sweep/result_store.h"
#include "study/sweep/round.h"

namespace faba {

/// Part `index` of `count` of the tasks, 1 <= index <= count: those whose number modulo count is index - 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
};

struct SweepOptions {
  unsigned threads = 0;  ///< 0: all processors
  Shard shard = {};
  /// Folder for measurements of the inputs of the study, such as videos, which take long and are needed
  /// again when the study is resumed. Empty: they are not stored.
  std::filesystem::path measured = {};
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };  ///< checked between tasks
  /// Called for each round whose results are complete, unless `elsewhere` is set.
  std::function<void(const Round&, const ResultStore&)> completed = [](const auto&, const auto&) {};
  /// Computes the missing results of a round in other processes; called for every round, also for one that is
  /// complete. Returns whether all results are in the store. Empty: the threads of this process compute them.
  std::function<bool(const Round&, ResultStore&)> elsewhere = {};
};

/// Computes the tasks of a round that have no result in `store`. Each result is stored immediately, so that a
/// killed sweep can be resumed. Returns whether the results of all tasks are available, including those of
/// other shards. A task that fails does not end the sweep, unless the first kHopelessTasks all fail; at the
/// end throws the error of the failed tasks. Throws Error(interrupted) when stopped.
bool sweep(ResultStore& store, const Round& round, const SweepOptions& options);

inline constexpr std::uint64_t kHopelessTasks = 10;

/// Tasks that failed: number in the round, reason.
using FailedTasks = std::map<std::uint64_t, std::string>;
/// Error of a round whose tasks `failed` have no result, although all others have. `first`: number of its
/// first task in the study; `attempts`: how often each was tried.
Error failed_tasks(const Round& round, const FailedTasks& failed, std::uint64_t first, int attempts,
                   Errc code = Errc::internal);

/// Numbers of the tasks of a round without a result, ascending.
std::vector<std::uint64_t> missing_tasks(const ResultStore& store, const Round& round);

/// Error of a study that was stopped.
Error study_stopped(const std::string& where = "");

}  // namespace faba
