#pragma once
#include <nlohmann/json.hpp>

#include "study/identify.h"

namespace faba {

/// What `faba identify --json` prints.
nlohmann::ordered_json identify_json(const Identification& result);

}  // namespace faba
