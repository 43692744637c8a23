#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/data/provenance.h"

namespace faba::cli {

struct Common;

/// Digests of `inputs`, which are read completely, and the options of the verb that were given and change its
/// result.
Provenance provenance_of(const Common& c, const std::vector<std::filesystem::path>& inputs);

/// Options of the verb that were given and change its result, with their values.
std::vector<std::pair<std::string, std::string>> options_with_effect(const Common& c);

/// Prints the result of a measurement with its provenance as one line of JSON.
void print_json(nlohmann::ordered_json result, const Provenance& p);

}  // namespace faba::cli
