#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/toml.h"

namespace faba {

/// View, outline, swarms, number and rate of the recorded frames, and the time of the first one, of a run,
/// for the page. Throws Error(input) for runs without tracks.
Json describe_run(const std::filesystem::path& dir);

/// Frames in the format of the live lab (web/protocol.md), each after its length in bytes (uint32). `from` is
/// an index of recorded frames. Returns at most kMostRunFrames frames.
inline constexpr std::uint64_t kMostRunFrames = 64;
std::string run_frames(const std::filesystem::path& dir, std::uint64_t from, std::uint64_t count);

}  // namespace faba
