#pragma once

namespace faba {

/// A run directory's files, for those that look into one.
namespace run_files {
inline constexpr const char* kMarker = "incomplete";
inline constexpr const char* kCheckpoint = "checkpoint";
inline constexpr const char* kScenario = "scenario.toml";
inline constexpr const char* kManifest = "manifest.json";
inline constexpr const char* kCommands = "commands.csv";  ///< of a bench
inline constexpr const char* kCoilsLog = "coils.log";     ///< likewise
}  // namespace run_files

}  // namespace faba
