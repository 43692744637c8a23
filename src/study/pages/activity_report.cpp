#include "study/pages/activity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/toml.h"
#include "study/pages/quality_output.h"

namespace faba {
namespace {

template <class T>
Json or_null(const std::optional<T>& v) {
  return v ? Json(*v) : Json();
}

Json gaussian_json(const GaussianFit& f) {
  if (!f.good && f.amplitude == 0) {  // no data for a fit
    Json j{{"good", false}, {"reason", f.reason}};
    for (const char* key : {"amplitude", "peak_s", "sigma_s", "offset"}) j[key] = nullptr;
    return j;
  }
  return {{"amplitude", f.amplitude},
          {"peak_s", f.peak_s},
          {"sigma_s", f.sigma_s},
          {"offset", f.offset},
          {"se_amplitude", f.se_amplitude},
          {"se_peak_s", f.se_peak_s},
          {"se_sigma_s", f.se_sigma_s},
          {"se_offset", f.se_offset},
          {"scatter", f.scatter},
          {"good", f.good},
          {"reason", f.reason}};
}

Json response_json(const Response& r) {
  Json j{{"reversal_s", r.source == Response::Source::detected ? Json() : Json(r.earliest_s)},
         {"reversal_source", reversal_source(r)},
         {"direction_deg", r.direction_deg},
         {"method", r.measure},
         {"fraction_method", r.fraction_method},
         {"t_statistic", std::isfinite(r.change.t_statistic) ? Json(r.change.t_statistic) : Json()},
         {"responds", r.responds},
         {"rise_s", r.change.rise_s}};
  j["displacement_px"] = r.flow ? Json(r.flow->shift_px) : Json();
  j["object_px"] = r.flow ? Json(r.flow->object_px) : Json();
  j["neighbour_px"] = r.flow ? or_null(r.flow->neighbour_px) : Json();
  j["flow_valid"] = r.flow ? Json(r.flow->valid()) : Json();
  return j;
}

void add_measured(Json& j, const std::string& key, const std::optional<Measured>& m) {
  j[key] = m ? Json(m->value) : Json();
  j[key + "_ci90"] = m ? Json{m->ci90[0], m->ci90[1]} : Json();
}

void add_response(Json& j, const VideoActivity& a) {
  const auto onset = onset_of(a);
  j["onset_s"] = onset ? Json(onset->t_s) : Json();
  j["onset_ci90"] = onset ? Json(onset->ci90) : Json();
  const std::optional<Measured> none, fraction = a.response ? a.response->fraction : none,
                                      speed = a.response ? a.response->speed_px_s : none;
  add_measured(j, "responding_fraction", fraction);
  add_measured(j, "speed_px_per_s", speed);
  add_measured(j, "speed_um_per_s", speed_um_s(a));
  j["response"] = a.response ? response_json(*a.response) : Json();
}

Json video_json(const VideoActivity& a) {
  Json j;
  j["video"] = a.input.file.string();
  j["exposure_s"] = or_null(a.input.exposure_s);
  j["experiment"] = a.input.experiment;
  add_scale(j, a.scale);
  j["um_per_px_se"] = or_null(a.scale.standard_error);
  j["pairs"] = a.t_s.size();
  j["threshold_px"] = a.threshold_px;
  j["direction_deg"] = a.direction_deg;
  j["direction_given"] = a.direction_given;
  j["segments"] = Json::array();
  for (const MotionSegment& s : a.segments)
    j["segments"].push_back({{"t0_s", s.t0_s}, {"t1_s", s.t1_s}, {"direction_deg", s.direction_deg}});
  j["mean_activity"] = a.mean_amount;
  j["mean_along"] = a.mean_along;
  j["visible_cells"] = or_null(a.visible_cells);
  j["mean_activity_per_cell"] = or_null(activity_per_cell(a));
  j["frame_s"] = a.frame_s;
  const bool finite = a.signal_to_noise && std::isfinite(*a.signal_to_noise);  // JSON has no infinity
  j["signal_to_noise"] = finite ? Json(*a.signal_to_noise) : Json();
  j["responds"] = a.responds;
  j["gaussian"] = gaussian_json(a.fit);
  add_response(j, a);
  j["maximum_s"] = or_null(a.maximum_s);
  j["departure_s"] = or_null(a.departure_s);
  add_quality(j, a.warnings);
  j["notes"] = a.notes;
  return j;
}

Json line_json(const std::optional<ExposureLine>& line) {
  if (!line) return {};
  return {{"slope", line->slope},           {"intercept", line->intercept},
          {"ci95", line->slope_ci95},       {"intercept_ci95", line->intercept_ci95},
          {"scatter_sd", line->scatter_sd}, {"experiment_sd", line->experiment_sd},
          {"values", line->values},         {"experiments", line->experiments}};
}

}  // namespace

const char* reversal_source(const Response& r) {
  switch (r.source) {
    case Response::Source::given:
      return "given";
    case Response::Source::recorded:
      return "recorded";
    case Response::Source::detected:
      return "detected";
  }
  return "";
}

std::string decimals(double value, double width) {
  const double step = width / 20;
  const int digits = step > 0 ? std::clamp(int(std::ceil(-std::log10(step))), 0, 6) : 2;
  return fmt::format("{:.{}f}", value, digits);
}

Json activity_json(const ActivityResult& r) {
  Json j;
  j["videos"] = Json::array();
  for (const VideoActivity& a : r.videos) j["videos"].push_back(video_json(a));
  const auto with_pooled = [](const auto& line, const auto& pooled) {
    Json one = line_json(line);
    if (!one.is_null()) one["pooled"] = line_json(pooled);
    return one;
  };
  j["peak_line"] = with_pooled(r.peak_line, r.peak_line_pooled);
  // In frames, as in the thesis.
  if (r.peak_line && r.frame_s)
    j["peak_line"]["frames"] = {{"rate_hz", 1 / *r.frame_s},
                                {"slope", r.peak_line->slope / *r.frame_s},
                                {"intercept", r.peak_line->intercept / *r.frame_s}};
  j["mean_line"] = with_pooled(r.mean_line, r.mean_line_pooled);
  j["per_cell_line"] = with_pooled(r.per_cell_line, r.per_cell_line_pooled);
  j["cutoff_s"] = r.cutoff ? Json(r.cutoff->cutoff_s) : Json();
  j["cutoff_wrong"] = r.cutoff ? Json(r.cutoff->wrong) : Json();
  j["cutoff_between_s"] = r.cutoff ? Json(r.cutoff->between_s) : Json();
  add_quality(j, all_warnings(r));
  return j;
}

std::string activity_csv(const ActivityResult& r) {
  std::string out = "video,t0_s,t1_s,activity,along\n";
  for (std::size_t i = 0; i < r.videos.size(); ++i) {
    const VideoActivity& a = r.videos[i];
    for (std::size_t k = 0; k < a.t_s.size(); ++k)
      out += fmt::format("{},{:.6f},{:.6f},{:.7g},{:.7g}\n", i + 1, a.signature.t0_s(k), a.signature.t1_s(k),
                         a.amount[k], a.along[k]);
  }
  return out;
}

}  // namespace faba
