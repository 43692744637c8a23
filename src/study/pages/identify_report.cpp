#include "study/pages/identify_report.h"

#include <cmath>

#include "core/toml.h"
#include "study/identify/identify_warnings.h"
#include "study/pages/quality_output.h"

namespace faba {
namespace {

Json parameter_json(const FoundParameter& p) {
  return {{"median", p.median},
          {"ci90", p.ci90},
          {"unit", p.parameter.unit},
          {"range", {p.parameter.low, p.parameter.high}},
          {"fraction_of_range", p.fraction_of_range},
          {"warning", p.doubt.empty() ? Json() : Json(p.doubt)},
          {"abc", {{"median", p.abc_median}, {"ci90", p.abc_ci90}}},
          {"resampled90", p.resampled90 ? Json(*p.resampled90) : Json()}};
}

// A parameter that the program frees by default, with its prior.
Json nuisance_json(const FoundParameter& p) {
  Json j = parameter_json(p);
  j["prior"] = p.parameter.nuisance_source;
  return j;
}

// Quantities with a known uncertainty: sampled in each simulation, not estimated.
Json sampled_json(const IdentifyStudy& s) {
  Json j = Json::object();
  const auto add = [&](const char* name, double sd, const char* source) {
    if (sd > 0) j[name] = {{"relative_sd", sd}, {"source", source}};
  };
  add("count", s.count_sd,
      "assumed error of the number of cells in the first frame; not if the study gives swarm[0].count");
  add("scale", s.scale_sd, "scale_uncertainty of the study, or the calibration file");
  add("field_strength", s.field_sd, "field_uncertainty of the study");
  return j;
}

Json family_json(const FamilyCheck& c) {
  return {{"aspect", c.aspect}, {"what", c.what},
          {"amount", c.amount}, {"sd", c.sd},
          {"unit", c.unit},     {"t", c.t},
          {"p", c.p},           {"explained", c.explained},
          {"effect", c.effect}, {"significant", c.significant}};
}

}  // namespace

nlohmann::ordered_json identify_json(const Identification& r) {
  Json j{{"title", r.study.title}, {"models", Json::array()}};
  for (const FoundModel& m : r.models) {
    Json one{{"name", m.name}};
    if (!m.failed.empty()) {
      one["failed"] = m.failed;
    } else {
      one["score"] = m.score;
      one["scores"] = m.scores;
      one["fit_p"] = m.fit_p;
      one["converged"] = m.converged;
      one["simulations"] = m.simulations;
      one["nuisances"] = Json::object();
      for (const FoundParameter& p : m.parameters) {
        if (p.parameter.nuisance())
          one["nuisances"][p.parameter.path] = nuisance_json(p);
        else
          one["parameters"][p.parameter.path] = parameter_json(p);
      }
      one["families"] = Json::array();
      for (const FamilyCheck& c : m.families) one["families"].push_back(family_json(c));
      one["checks"] = Json::array();
      for (const StatisticCheck& c : checks_of(r, m))
        one["checks"].push_back({{"what", c.name},
                                 {"observed", c.observed},
                                 {"predicted", c.predicted},
                                 {"sd", c.sd},
                                 {"deviation", std::isfinite(c.deviation()) ? Json(c.deviation()) : Json()},
                                 {"fits", c.fits()}});
    }
    j["models"].push_back(std::move(one));
  }
  j["sampled"] = sampled_json(r.study);
  j["best"] = r.models[r.best].name;
  j["evidence"] = r.evidence;
  j["summary"] = r.words;
  j["experiments"] = r.experiments;
  j["score_lead"] = r.score_lead_ci95 ? Json{{"mean", r.score_lead}, {"ci95", *r.score_lead_ci95}} : Json();
  j["statistics"] = Json::array();
  for (std::size_t k = 0; k < r.statistics.size(); ++k) {
    Json one{{"what", r.statistics[k].name},
             {"observed", r.statistics[k].observed},
             {"predicted", Json::object()}};
    for (const FoundModel& m : r.models)
      if (m.failed.empty()) one["predicted"][m.name] = {{"mean", m.predicted[k]}, {"sd", m.predicted_sd[k]}};
    one["predicted90"] = r.models[r.best].predicted90[k];
    j["statistics"].push_back(std::move(one));
  }
  for (const LegacyModel& m : r.legacy)
    j["legacy"].push_back(
        {{"name", m.name},
         {"parameter", m.parameter.path},
         {"zero", m.zero},
         {"zero_ci95", m.zero_ci95 ? Json(*m.zero_ci95) : Json()},
         {"slope_of_slopes",
          {{"slope", m.slopes.slope}, {"se", m.slopes.se_slope}, {"intercept", m.slopes.intercept}}},
         {"mean", m.mean},
         {"sd", m.sd},
         {"least_distance_at", m.least_distance_at},
         {"invalid_reason", m.invalid_reason.empty() ? Json() : Json(m.invalid_reason)}});
  add_quality(j, identify_warnings(r));
  j["notes"] = notes_of(r);
  return j;
}

std::vector<std::string> notes_of(const Identification& r) {
  std::vector<std::string> all;
  for (const ResponseVideo& v : r.videos)
    for (const std::string& note : v.notes) {
      const std::string name = v.input.file.string() + ": ";
      all.push_back(note.starts_with(name) ? note : name + note);
    }
  return all;
}

}  // namespace faba
