#include "study/pages/quality_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/plot/markup.h"

namespace faba {

void add_quality(nlohmann::ordered_json& j, const std::vector<Warning>& warnings) {
  j["quality"] = word_of(quality_of(warnings));
  add_warnings(j, warnings);
}

void add_warnings(nlohmann::ordered_json& j, const std::vector<Warning>& warnings) {
  j["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& w : warnings)
    j["warnings"].push_back(
        {{"aspect", w.aspect}, {"what", w.what}, {"evidence", w.evidence}, {"advice", w.advice}});
}

void add_scale(nlohmann::ordered_json& j, const VideoScale& scale) {
  j["um_per_px"] = scale.um_per_px ? Json(*scale.um_per_px) : Json();
  j["um_per_px_source"] = scale.um_per_px && !scale.source.empty() ? Json(scale.source) : Json();
}

std::string quality_markup(const std::vector<Warning>& warnings) {
  if (warnings.empty()) return "";
  std::string out =
      fmt::format("<p>Quality of the measurement: <b>{}</b>.</p>\n", word_of(quality_of(warnings)));
  for (const Warning& w : warnings)
    out += fmt::format("<p class=\"warning\">{}.</p>\n", escape_markup(sentence(w)));
  return out;
}

}  // namespace faba
