#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace faba {

/// A property of a task for tables: seed 7, model "slow", swarm[0].model.speed 1.2e-4 (SI units).
struct TaskLabel {
  std::string name;
  std::string text;
  std::optional<double> number = {};  ///< empty for a word
};

/// Tasks of a study that do not depend on each other: the trials of a comparison, the simulations between two
/// proposals of a search. A study is a sequence of rounds, of which each can depend on the results of those
/// before it.
struct Round {
  /// Bytes that determine, together with the study, the work of every task. Any process that has read the
  /// study makes the same round from them.
  std::string description;
  std::uint64_t size = 0;
  /// The result of a task, 0 <= task < size. Several threads call it, in any order; it depends only on the
  /// task. The values can be NaN.
  std::function<std::vector<double>(std::uint64_t task)> work;
  /// What the task computes.
  std::function<std::vector<TaskLabel>(std::uint64_t task)> labels = [](std::uint64_t) {
    return std::vector<TaskLabel>();
  };
};

/// A task of any round of a study. `round`: key of the round, ResultStore::key().
struct TaskId {
  std::uint64_t round = 0, task = 0;
  friend auto operator<=>(const TaskId&, const TaskId&) = default;
};

}  // namespace faba
