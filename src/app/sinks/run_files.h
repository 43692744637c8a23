#pragma once

namespace faba {

/// Names of files in a run directory.
namespace run_files {
inline constexpr const char* kMarker = "incomplete";
inline constexpr const char* kCheckpoint = "checkpoint";
inline constexpr const char* kScenario = "scenario.toml";
inline constexpr const char* kManifest = "manifest.json";
inline constexpr const char* kRoCrate = "ro-crate-metadata.json";
inline constexpr const char* kCommands = "commands.csv";  ///< of a run on a bench
inline constexpr const char* kCoilsLog = "coils.log";     ///< of a run on a bench
}  // namespace run_files

}  // namespace faba
