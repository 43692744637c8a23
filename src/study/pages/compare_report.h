#pragma once
#include <string>

#include <nlohmann/json.hpp>

#include "study/motion/compare.h"

namespace faba {

/// What `faba compare --json` prints: `reference`, `reference_t0_s`, `alignment`, `direction_deg`,
/// `flow_threshold_px`, `m`, `threshold`; `runs[]` =
/// `{"run","t0_s","pairs","mean","sd","slope","slope_ci95","intercept","score","legacy":{"mean","sd",
/// "slope","intercept"},"notes"}`; `floor` (null when not known) and `floor_from`, `naive` (a number: the
/// mean distance to a video in which nothing moves), `notes`. `score` is (mean - floor) / (naive - floor): 0
/// as good as the same model with another seed, 1 no better than nothing.
nlohmann::ordered_json compare_json(const Comparison& c, const CompareJob& job);

/// Distances over time, and for each run both filtered flows with their histograms (the thesis's Figs. 3.27
/// to 3.29), as one page.
std::string compare_page(const Comparison& c, const CompareJob& job);

/// `run,t_s,distance,legacy`, the run by its number from 1 on, 0 for the video in which nothing moves.
std::string compare_csv(const Comparison& c);

}  // namespace faba
