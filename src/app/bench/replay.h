#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace faba {

/// How the commands of a recorded bench run compare with those that its pictures lead to now.
struct Replayed {
  std::uint64_t recorded = 0;                ///< commands in the recording
  std::uint64_t equal = 0;                   ///< of them the same bit for bit
  std::optional<std::uint64_t> first_other;  ///< frame of the first that is not
};

/// Does the decisions of the run in `dir` again. Throws Error(input) when it is none of a bench, or kept no
/// lossless video. `keep_running` is asked after every frame; Error(interrupted) when it says no.
Replayed replay_run(const std::filesystem::path& dir,
                    const std::function<bool(std::uint64_t done, std::uint64_t of)>& keep_running);

}  // namespace faba
