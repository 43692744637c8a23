#include "study/pages/provenance_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "study/plot/markup.h"

namespace faba {
namespace {

constexpr std::size_t kShortDigest = 12;  // digits, as many as git shows in a large repository

}  // namespace

void add_provenance(nlohmann::ordered_json& j, const Provenance& p) {
  nlohmann::ordered_json& out = j["provenance"];
  out["version"] = FABA_VERSION;
  out["inputs"] = nlohmann::ordered_json::array();
  for (const Provenance::Input& one : p.inputs)
    out["inputs"].push_back({{"path", one.path}, {"sha256", one.sha256}});
  out["options"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : p.options)
    out["options"][name] = value.empty() ? nlohmann::ordered_json(true) : nlohmann::ordered_json(value);
}

std::string short_digest(const std::string& sha256) {
  return fmt::format("<code title=\"{}\">{}</code>", sha256, sha256.substr(0, kShortDigest));
}

std::string provenance_markup(const Provenance& p) {
  std::string out =
      "<h2>Provenance</h2>\n<table class=\"facts\"><tbody>\n<tr><th "
      "scope=\"row\">Program</th><td>Faba " FABA_VERSION "</td></tr>\n";
  for (const Provenance::Input& one : p.inputs)
    out += fmt::format("<tr><th scope=\"row\">Input</th><td>{}, SHA-256 {}</td></tr>\n",
                       escape_markup(one.path), short_digest(one.sha256));
  std::string options;
  for (const auto& [name, value] : p.options)
    options += fmt::format("<code>{}{}{}</code> ", name, value.empty() ? "" : " ", escape_markup(value));
  return out + fmt::format("<tr><th scope=\"row\">Options</th><td>{}</td></tr>\n</tbody></table>\n",
                           options.empty() ? "defaults" : options + "(others: defaults)");
}

}  // namespace faba
