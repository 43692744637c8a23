#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/steering/loop_design.h"

namespace faba {

nlohmann::ordered_json design_json(const LoopDesign& o);
/// Lines of text: the plant, the gains, the poles and the margins.
std::string design_text(const LoopDesign& o);

}  // namespace faba
