#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "study/sweep/result_store.h"
#include "study/sweep/round.h"
#include "study/sweep/round_file.h"

namespace faba {

/// Failed attempts of a task after which the study does not try it again.
inline constexpr int kMostAttempts = 3;

/// Numbers the tasks of a study over its rounds, and writes each round that has open tasks to the directory
/// of the study, so that other processes can work on it. As SweepOptions::elsewhere it only plans: the study
/// ends at the first round that is not complete.
class RoundPlanner {
 public:
  explicit RoundPlanner(std::filesystem::path dir) : dir_(std::move(dir)) {}
  /// Whether the round is complete; plans it otherwise. Throws Error(internal) when each task without a
  /// result has failed kMostAttempts times.
  bool operator()(const Round& round, ResultStore& store);
  /// The numbers of the next round; call it once for each round, in their order. Writes the round if `open`.
  PlannedRound plan(const Round& round, const ResultStore& store, bool open);

  /// The first round that is not complete, and the numbers of its open tasks.
  const PlannedRound& open_round() const { return open_round_; }
  const std::vector<std::uint64_t>& open_tasks() const { return open_tasks_; }

 private:
  std::filesystem::path dir_;
  std::uint64_t next_ = 1;
  PlannedRound open_round_;
  std::vector<std::uint64_t> open_tasks_;
};

/// Text of a list of ascending numbers, such as "1-20,45", and its inverse, which throws Error(usage) for any
/// other text and for more than 1e8 numbers.
std::string number_list(const std::vector<std::uint64_t>& numbers);
std::vector<std::uint64_t> numbers_in(const std::string& text);

}  // namespace faba
