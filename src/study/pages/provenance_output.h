#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/data/provenance.h"

namespace faba {

/// Adds `provenance` = {version, inputs[] = {path, sha256}, options = {NAME: value}} to the output of a
/// measurement.
void add_provenance(nlohmann::ordered_json& j, const Provenance& p);
/// For the end of a page: section with the version, the inputs with the first digits of their digests, and
/// the options.
std::string provenance_markup(const Provenance& p);
/// The first digits of a digest, with all digits as tooltip.
std::string short_digest(const std::string& sha256);

}  // namespace faba
