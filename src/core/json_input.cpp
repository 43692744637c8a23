#include "core/json_input.h"

namespace faba {

Json parse_json(std::string_view text) {
  constexpr int kDeepest = 64;  // scenarios have five levels, reports about ten
  struct TooDeep {};
  const auto limited = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw TooDeep();
    return true;
  };
  try {
    return Json::parse(text, limited, false);
  } catch (const TooDeep&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace faba
