#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/recording/manifest.h"

namespace faba {

/// Names of the files that a resolved scenario reads, without their folders: fields, libraries, recordings
/// and backgrounds. Coil systems and calibrations are part of the scenario itself.
std::vector<std::string> input_files(const Json& resolved_scenario);

/// Content of ro-crate-metadata.json of a complete run: an RO-Crate 1.1 with the profile Process Run Crate
/// 0.5, by which archives and other programs read what a directory contains and how it was made
/// (https://www.researchobject.org/ro-crate). It depends on the arguments and on the names of the files in
/// `dir` only. `inputs`: input_files(); `end_date`: UTC, ISO 8601.
Json ro_crate(const Manifest& m, const std::filesystem::path& dir, const std::vector<std::string>& inputs,
              const std::string& end_date);

}  // namespace faba
