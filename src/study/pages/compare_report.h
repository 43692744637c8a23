#pragma once
#include <string>

#include <nlohmann/json.hpp>

#include "study/data/provenance.h"
#include "study/motion/compare.h"

namespace faba {

/// Output of `faba compare --json`: `reference`, `reference_t0_s`, `alignment`, `direction_deg`,
/// `flow_threshold_px`, `m`, `threshold`; `runs[]` =
/// `{"run","t0_s","pairs","mean","sd","slope","slope_ci95","intercept","score","legacy":{"mean","sd",
/// "slope","intercept"},"notes"}`; `floor` (null when unknown) and `floor_from`, `naive` (mean distance to
/// a video without motion), `notes`. `score` is (mean - floor) / (naive - floor): 0 is the distance of the
/// same scenario with a different seed, 1 that of a video without motion.
nlohmann::ordered_json compare_json(const Comparison& c, const CompareJob& job);

/// HTML report: distances over time, and for each run both filtered flows with their histograms (Figs. 3.27
/// to 3.29 of the thesis).
std::string compare_page(const Comparison& c, const CompareJob& job, const Provenance& provenance);

/// CSV: `run,t_s,distance,legacy`; runs are numbered from 1, 0 is the video without motion.
std::string compare_csv(const Comparison& c);

}  // namespace faba
