#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "study/sweep/round.h"

namespace faba {

/// A round of a study in a file, from which any process can compute tasks of it. The tasks of a study are
/// numbered from 1 in the order of its rounds, so that a number denotes one task for ever.
struct PlannedRound {
  std::uint64_t first = 1;  ///< number of the first task
  std::uint64_t size = 0;
  std::string description;
  bool contains(std::uint64_t number) const { return number >= first && number - first < size; }
};

/// Writes a round to the directory of a study, unless it is there already. Throws Error(internal).
void plan_round(const std::filesystem::path& dir, const std::string& study_hash, const PlannedRound& round);

/// The round that contains the task with this number. Throws Error(usage) when it is not planned, or when the
/// file belongs to a different study; Error(input) for a damaged file.
PlannedRound planned_round(const std::filesystem::path& dir, const std::string& study_hash,
                           std::uint64_t number);

/// All rounds in the directory of a study, in their order. Throws as planned_round().
std::vector<PlannedRound> planned_rounds(const std::filesystem::path& dir, const std::string& study_hash);

}  // namespace faba
