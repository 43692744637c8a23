#pragma once
#include <nlohmann/json.hpp>

#include "study/identify/identify.h"

namespace faba {

/// What `faba identify --json` prints.
nlohmann::ordered_json identify_json(const Identification& result);
/// What is to be known of the videos, each with its name.
std::vector<std::string> notes_of(const Identification& result);
/// Everything as one self-contained HTML page: words, tables, curves, pictures of the video beside simulated
/// ones. Simulates some segments again for the pictures.
std::string identify_page(const Identification& result);

}  // namespace faba
