#pragma once
#include <filesystem>
#include <string>

#include "core/toml.h"

namespace faba {

inline constexpr const char* kTagsFile = "tags.json";  ///< in the folder of a run

/// The entry of a run in the list of runs, without the members of measure_run(). Throws Error or
/// Json::exception for an invalid manifest.
Json run_card(const std::string& name, const std::filesystem::path& dir);

/// Adds what must be read from long files: `controller`, `settling_time_s`, `steady_rms_px` and
/// `steady_rms_um`, null if not defined, and `measured`. Never throws: a damaged file gives null.
void measure_run(Json& card, const std::filesystem::path& dir);

/// The tags and the note in a request, as the content of the file. Throws Error(usage).
Json tags_of(const Json& asked);

}  // namespace faba
