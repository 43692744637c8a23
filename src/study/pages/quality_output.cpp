#include "study/pages/quality_output.h"

#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/plot/markup.h"

namespace faba {
namespace {

// The same warning about several videos, with the evidence of each.
struct WarningGroup {
  Warning first;
  std::vector<std::string> evidence;
};

std::vector<WarningGroup> grouped(const std::vector<Warning>& warnings) {
  std::vector<WarningGroup> groups;
  for (const Warning& w : warnings) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const WarningGroup& g) {
      return g.first.aspect == w.aspect && g.first.what == w.what && g.first.advice == w.advice;
    });
    WarningGroup& group = same == groups.end() ? groups.emplace_back(WarningGroup{w, {}}) : *same;
    if (!w.evidence.empty()) group.evidence.push_back(w.evidence);
  }
  return groups;
}

// Each text is an element of its own, so that a page can translate it.
std::string span(const std::string& text) { return "<span>" + escape_markup(text) + "</span>"; }

std::string warning_markup(const WarningGroup& group) {
  const Warning& w = group.first;
  std::string out = fmt::format("<div class=\"warning\">\n<p><b>{}</b></p>\n<p class=\"sentence\">{}</p>\n",
                                title_of_aspect(w.aspect), escape_markup(w.what));
  std::string parts;
  for (const std::string& evidence : group.evidence)
    parts += fmt::format("<dd>{}</dd>\n", escape_markup(evidence));
  if (!parts.empty()) parts = "<dt>Evidence</dt>" + parts;
  if (!w.advice.empty())
    parts += fmt::format("<dt>Advice</dt><dd class=\"sentence\">{}</dd>\n", escape_markup(w.advice));
  return out + (parts.empty() ? "" : "<dl>\n" + parts + "</dl>\n") + "</div>\n";
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
  for (const WarningGroup& group : grouped(warnings)) out += warning_markup(group);
  return out;
}

std::string note_markup(const std::string& note, const std::string& file, const char* style) {
  const std::string where = file.empty() ? "" : span(file) + ": ";
  return fmt::format("<p class=\"{}\">{}{}.</p>\n", style, where, span(note));
}

}  // namespace faba
