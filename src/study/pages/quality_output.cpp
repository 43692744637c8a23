#include "study/pages/quality_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/plot/markup.h"

namespace faba {
namespace {

// The parts of a warning are texts of their own, because pages translate a report text by text.
std::string span(const std::string& text) { return fmt::format("<span>{}</span>", escape_markup(text)); }

std::string warning_markup(const Warning& w) {
  std::string out = span(w.aspect) + ": " + span(w.what);
  if (!w.evidence.empty()) out += " (" + span(w.evidence) + ")";
  if (!w.advice.empty()) out += "; " + span(w.advice);
  return fmt::format("<p class=\"warning\">{}.</p>\n", out);
}

}  // namespace

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
  for (const Warning& w : warnings) out += warning_markup(w);
  return out;
}

std::string note_markup(const std::string& note, const std::string& file, const char* style) {
  const std::string where = file.empty() ? "" : span(file) + ": ";
  return fmt::format("<p class=\"{}\">{}{}.</p>\n", style, where, span(note));
}

}  // namespace faba
