#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "study/plot/figure.h"
#include "study/steering/controller_study.h"

namespace faba {

/// What `faba compare-controllers --json` prints: `combinations[]` = `{"controller", "model", "delay_frames",
/// "trials", "settled", "settled_ci95", "metrics": {NAME: {"mean", "sd", "ci95", "n"}}, "behind_best_px"}`,
/// NAME as in `faba run --json`.
nlohmann::ordered_json controllers_json(const ControllerComparison& comparison);

/// The table as CSV: a line for each combination and metric.
std::string controllers_csv(const ControllerComparison& comparison);

/// Distance and dispersion over time for each model and delay; with several delays the steady error against
/// them.
std::vector<Figure> controllers_figures(const ControllerComparison& comparison);

/// All of it as one page.
std::string controllers_page(const ControllerComparison& comparison);

}  // namespace faba
