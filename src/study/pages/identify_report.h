#pragma once
#include <nlohmann/json.hpp>

#include "study/data/provenance.h"
#include "study/identify/identify.h"

namespace faba {

/// Output of `faba identify --json`.
nlohmann::ordered_json identify_json(const Identification& result);
/// Notes on the videos, each with the name of its file.
std::vector<std::string> notes_of(const Identification& result);
/// Self-contained HTML report: verdict, tables, figures, and frames of the videos beside simulated frames.
/// Simulates the first episodes again for these frames.
std::string identify_page(const Identification& result, const Provenance& provenance = {});

}  // namespace faba
