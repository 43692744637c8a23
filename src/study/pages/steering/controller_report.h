#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "study/data/provenance.h"
#include "study/plot/figure.h"
#include "study/steering/controller_study.h"

namespace faba {

/// Output of `faba compare-controllers --json`: `combinations[]` = `{"controller", "model", "delay_frames",
/// "trials", "settled", "settled_ci95", "metrics": {NAME: {"mean", "sd", "ci95", "n"}},
/// "excess_over_best_px"}`, NAME as in `faba run --json`.
nlohmann::ordered_json controllers_json(const ControllerComparison& comparison);

/// The table as CSV, one line for each combination and metric.
std::string controllers_csv(const ControllerComparison& comparison);

/// Distance and dispersion over time for each model and delay; with several delays also the steady-state
/// error against delay.
std::vector<Figure> controllers_figures(const ControllerComparison& comparison);

/// HTML report.
std::string controllers_page(const ControllerComparison& comparison, const Provenance& provenance);

}  // namespace faba
