#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/data/provenance.h"
#include "study/steering/tuning.h"

namespace faba {

/// What limits the validity of the result: a value at the end of its range, no improvement on other seeds.
std::vector<std::string> tuning_notes(const Tuning& t);
nlohmann::ordered_json tuning_json(const Tuning& t);
std::string tuning_page(const Tuning& t, const Provenance& provenance);
/// The metric that is minimised with half of its interval and its unit, "0.31 ± 0.02 px"; `plus_minus`: the
/// sign.
std::string tuned_text(const Tuning& t, const MeanOverSeeds& m, const char* plus_minus = "±");
/// A value of a parameter with its unit, such as "0.12 s".
std::string shown_value(const TunedParameter& p, double value);

}  // namespace faba
