#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "app/scenario/parts.h"

namespace faba {

/// Comparison of the commands of a recorded bench run with those computed again from its pictures.
struct Replayed {
  std::uint64_t recorded = 0;                     ///< commands in the recording
  std::uint64_t equal = 0;                        ///< number of bit-identical commands
  std::optional<std::uint64_t> first_difference;  ///< frame of the first different command
};

/// Computes the commands of the run in `dir` again with `parts`. Throws Error(input) if it is not a run on a
/// bench or has no lossless video. `keep_running` is called after every frame; throws Error(interrupted) if
/// it returns false.
Replayed replay_run(const std::filesystem::path& dir, const Parts& parts,
                    const std::function<bool(std::uint64_t done, std::uint64_t total)>& keep_running);

}  // namespace faba
