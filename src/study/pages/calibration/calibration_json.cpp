#include <cmath>
#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/pages/calibration/calibration_report.h"
#include "study/pages/quality_output.h"

namespace faba {
namespace {

Json number_or_null(double v) { return std::isfinite(v) ? Json(v) : Json(); }

Json coverage_json(const Coverage& c) {
  return {{"level", c.level},
          {"inside", c.inside},
          {"experiments", c.experiments},
          {"ci95", c.ci95()},
          {"band99", {c.low, c.high}},
          {"calibrated", c.within() && !c.tells() ? Json() : Json(c.within())}};
}

Json ranks_json(const RankHistogram& h) {
  return {{"counts", h.counts},
          {"expected", h.expected},
          {"band99", {h.low, h.high}},
          {"outside", h.outside()},
          {"band99_each", {h.low_each, h.high_each}},
          {"outside_each", h.outside_each()},
          {"p", h.p}};
}

Json calibrated_parameter_json(const ParameterCalibration& p) {
  Json j{{"unit", p.parameter.unit},
         {"nuisance", p.parameter.nuisance()},
         {"range", {p.parameter.low, p.parameter.high}},
         {"coverage", Json::array()},
         {"ranks", ranks_json(p.ranks)},
         {"bias_sd", {{"mean", p.bias}, {"se", number_or_null(p.bias_se)}, {"sd", number_or_null(p.spread)}}},
         {"relative_bias", number_or_null(p.relative_bias)},
         {"relative_error", number_or_null(p.relative_error)},
         {"fraction_of_range", p.fraction_of_range}};
  for (const Coverage& c : p.coverage) j["coverage"].push_back(coverage_json(c));
  return j;
}

Json count_json(const ExperimentCount& n) {
  return {
      {"count", n.of > 0 ? Json(n.count) : Json()}, {"of", n.of}, {"ci95", n.of > 0 ? Json(n.ci95) : Json()}};
}

Json selection_json(const SelectionCalibration& s) {
  return {{"kind", s.kind},
          {"misspecified", s.misspecified},
          {"experiments", s.experiments},
          {"failed", s.failed},
          {"sampled_again", s.sampled_again},
          {"best_is_true", count_json(s.best_is_true)},
          {"clear", count_json(s.clear)},
          {"weak", count_json(s.weak)},
          {"wrong_clear", count_json(s.wrong_clear)},
          {"false_clear", count_json(s.false_clear)},
          {"false_clear_unnamed", count_json(s.false_clear_unnamed)},
          {"named", count_json(s.named)},
          {"with_warnings", count_json(s.warned)},
          {"inside90", count_json(s.inside)}};
}

Json experiment_json(const StudyCalibration& c, std::size_t i) {
  const CalibrationRecord& r = c.records[i];
  constexpr const char* kEvidence[] = {"none", "weak", "clear"};
  const Candidate& model = c.study.design.candidates[std::size_t(r.true_model)];
  Json j{{"kind", c.study.kinds[c.study.kind_of(i).first].name}, {"true_model", model.model.name}};
  if (r.failed) {
    j["failed"] = true;
    return j;
  }
  j["best"] = c.study.design.candidates[std::size_t(r.best)].model.name;
  j["evidence"] = kEvidence[std::size_t(r.evidence)];
  j["fit_p"] = r.fit_p;
  j["parameters"] = Json::object();
  for (std::size_t k = 0; k < r.estimates.size(); ++k) {
    const CalibratedEstimate& e = r.estimates[k];
    j["parameters"][model.free[k].path] = {
        {"true", e.truth}, {"median", e.median},          {"mean", e.mean},
        {"sd", e.sd},      {"ci90", {e.low90, e.high90}}, {"rank", e.rank}};
  }
  return j;
}

}  // namespace

nlohmann::ordered_json calibration_json(const StudyCalibration& c) {
  Json j{{"title", c.study.title},
         {"study", c.study.designed_by},
         {"design_hash", design_hash(c.study.design)},
         {"seed", c.study.seed},
         {"look", c.study.design.look == Look::video ? "video" : "positions"},
         {"simulations", c.study.design.simulations},
         {"models", Json::object()},
         {"kinds", Json::array()}};
  for (const ModelCalibration& m : c.models) {
    Json one{{"experiments", m.experiments}, {"parameters", Json::object()}};
    for (const ParameterCalibration& p : m.parameters)
      one["parameters"][p.parameter.path] = calibrated_parameter_json(p);
    one["tarp"] = {{"level", m.tarp.at},
                   {"fraction", m.tarp.fraction},
                   {"largest_difference", m.tarp.largest},
                   {"p", m.tarp.p}};
    j["models"][m.name] = std::move(one);
  }
  for (const SelectionCalibration& s : c.kinds) j["kinds"].push_back(selection_json(s));
  add_quality(j, calibration_warnings(c));
  j["experiments"] = Json::array();
  for (std::size_t i = 0; i < c.records.size(); ++i) j["experiments"].push_back(experiment_json(c, i));
  return j;
}

}  // namespace faba
