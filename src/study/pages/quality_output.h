#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/quality/quality.h"

namespace faba {

/// Adds `quality` and `warnings` = [{aspect, what, evidence, advice}] to the output of a measurement.
void add_quality(nlohmann::ordered_json& j, const std::vector<Warning>& warnings);
/// For a page: the quality, and a box for each warning. Empty without warnings.
std::string quality_markup(const std::vector<Warning>& warnings);

}  // namespace faba
