#include "study/pages/quality_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/plot/markup.h"

namespace faba {
namespace {

// Each text is an element of its own, so that a page can translate it.
std::string warning_markup(const Warning& w) {
  std::string out = fmt::format("<div class=\"warning\">\n<p><b>{}</b></p>\n<p class=\"sentence\">{}</p>\n",
                                title_of_aspect(w.aspect), escape_markup(w.what));
  if (w.evidence.empty() && w.advice.empty()) return out + "</div>\n";
  out += "<dl>\n";
  if (!w.evidence.empty())
    out += fmt::format("<dt>Evidence</dt><dd class=\"sentence\">{}</dd>\n", escape_markup(w.evidence));
  if (!w.advice.empty())
    out += fmt::format("<dt>Advice</dt><dd class=\"sentence\">{}</dd>\n", escape_markup(w.advice));
  return out + "</dl>\n</div>\n";
}

}  // namespace

void add_quality(nlohmann::ordered_json& j, const std::vector<Warning>& warnings) {
  j["quality"] = word_of(quality_of(warnings));
  add_warnings(j, warnings);
}

void add_warnings(nlohmann::ordered_json& j, const std::vector<Warning>& warnings) {
  j["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& w : warnings)
    j["warnings"].push_back({{"aspect", w.aspect},
                             {"title", title_of_aspect(w.aspect)},
                             {"what", w.what},
                             {"evidence", w.evidence},
                             {"advice", w.advice}});
}

void add_scale(nlohmann::ordered_json& j, const VideoScale& scale) {
  j["um_per_px"] = scale.um_per_px ? Json(*scale.um_per_px) : Json();
  j["um_per_px_source"] = scale.um_per_px && !scale.source.empty() ? Json(scale.source) : Json();
}

std::string quality_markup(const std::vector<Warning>& warnings) {
  const Quality quality = quality_of(warnings);
  std::string out = fmt::format(
      "<p class=\"quality\"><b>Quality of the measurement: {}</b></p>\n<p class=\"note\">{}.</p>\n",
      word_of(quality), meaning_of(quality));
  for (const Warning& w : warnings) out += warning_markup(w);
  return out;
}

std::string note_markup(const std::string& note, const std::string& file, const char* style) {
  const std::string where = file.empty() ? "" : escape_markup(file) + ": ";
  return fmt::format("<p class=\"{}\">{}{}.</p>\n", style, where, "<span>" + escape_markup(note) + "</span>");
}

}  // namespace faba
