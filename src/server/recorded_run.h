#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/toml.h"

namespace faba {

/// What the page needs to show a recorded run: its view, outline, swarms and how many frames were kept.
/// Throws Error(input) for runs without tracks.
Json describe_run(const std::filesystem::path& dir);

/// Some of its frames as the live lab sends them (web/protocol.md), each after its length in bytes (uint32).
/// `from` counts kept frames. At most kMostRunFrames.
inline constexpr std::uint64_t kMostRunFrames = 64;
std::string run_frames(const std::filesystem::path& dir, std::uint64_t from, std::uint64_t count);

}  // namespace faba
