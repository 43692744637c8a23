#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "study/pages/calibration/calibration_report.h"
#include "study/plot/markup.h"

namespace faba {
namespace {

std::string not_calibrated(const std::string& reason) {
  return fmt::format("<p class=\"warning\">The intervals of this study are not calibrated: {}.</p>\n",
                     escape_markup(reason));
}

// "speed 90.3 % of 300 experiments" for each parameter of the study.
std::string coverages_of(const nlohmann::json& models) {
  std::string out;
  for (const auto& [model, m] : models.items())
    for (const auto& [path, p] : m.at("parameters").items()) {
      if (p.at("nuisance").get<bool>()) continue;
      for (const auto& c : p.at("coverage"))
        if (c.at("level") == 0.9)
          out += fmt::format("{}<span>{}: {} in {} of {} (right intervals: {} to {})</span>",
                             out.empty() ? "" : ", ", escape_markup(model), escape_markup(path),
                             c.at("inside").get<int>(), c.at("experiments").get<int>(),
                             c.at("band99")[0].get<int>(), c.at("band99")[1].get<int>());
    }
  return out;
}

}  // namespace

std::string calibration_note(const IdentifyStudy& study) {
  namespace fs = std::filesystem;
  if (study.calibration.empty())
    return not_calibrated(
        "run `faba calibrate` with the study, and give calibration = \"calibration.json\" in the study");
  std::error_code ec;
  const std::string name = study.calibration.string();
  if (!fs::is_regular_file(study.calibration, ec)) return not_calibrated(name + " does not exist");
  const auto j = nlohmann::json::parse(read_file(study.calibration), nullptr, false);
  if (!j.is_object() || !j.contains("design_hash") || !j.contains("models") || !j.contains("look"))
    return not_calibrated(name + " is not a result of `faba calibrate`");
  if (j["design_hash"] != design_hash(study))
    return not_calibrated(name + " is of another design; calibrate this study again");
  return fmt::format(
      "<p class=\"details\"><span>Calibration of this study ({}, {}): the 90 % interval contains the true "
      "value:</span> {}.</p>\n",
      escape_markup(name), j["look"] == "video" ? "rendered experiments" : "positions",
      coverages_of(j["models"]));
}

}  // namespace faba
