#include "study/pages/tracks/track_json.h"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "core/statistics.h"
#include "core/toml.h"
#include "study/pages/quality_output.h"

namespace faba {
namespace {

// Two-sided 95 % quantile of Student's t with 19 degrees of freedom: 20 groups in the jackknife.
constexpr double kStudent95 = 2.093;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

// Writes NAME_px_s with standard error and interval, and the same in um; `power`: of the length in the unit.
struct Writer {
  Json json;
  double um_per_px = 0;

  void put(const std::string& name, const std::string& px, const std::string& um, int power,
           const Estimated& e) {
    one(name + "_" + px, 1, e);
    if (um_per_px > 0) one(name + "_" + um, power == 2 ? um_per_px * um_per_px : um_per_px, e);
  }
  void one(const std::string& key, double scale, const Estimated& e) {
    json[key] = number(scale * e.value);
    json[key + "_se"] = number(scale * e.se);
    const double half = kStudent95 * e.se;
    json[key + "_ci95"] = {number(scale * (e.value - half)), number(scale * (e.value + half))};
  }
  void list(const std::string& px, const std::string& um, const std::vector<double>& v) {
    Json a = Json::array(), b = Json::array();
    for (const double x : v) {
      a.push_back(number(x));
      b.push_back(number(um_per_px * x));
    }
    json[px] = a;
    if (um_per_px > 0) json[um] = b;
  }
};

Json list_of(const std::vector<double>& v) {
  Json a = Json::array();
  for (const double x : v) a.push_back(number(x));
  return a;
}

Json msd_of(const Msd& m) {
  return {{"lag_s", list_of(m.lag_s)},
          {"msd_px2", list_of(m.msd_px2)},
          {"se_px2", list_of(m.se_px2)},
          {"pairs", list_of(m.pairs)}};
}

Json misfit_json(const MsdMisfit& m) {
  return {{"lag_s", number(m.lag_s)},
          {"deviation", number(m.deviation)},
          {"deviation_se", number(m.se)},
          {"significant", m.significant}};
}

Json diffusion_of(const TrackSummary& s, double um) {
  if (!s.diffusion.good) return nullptr;
  Writer w{Json::object(), um};
  w.put("d", "px2_s", "um2_s", 2, s.d_px2_s);
  w.json["offset_px2"] = number(s.diffusion.offset_px2);
  w.json["first_lag_s"] = s.msd.lag_s[s.diffusion.first];
  w.json["lags"] = s.diffusion.lags;
  w.json["misfit"] = misfit_json(s.diffusion_misfit);
  return w.json;
}

Json walk_of(const TrackSummary& s, double um) {
  if (!s.persistent.good) return nullptr;
  Writer w{Json::object(), um};
  w.put("speed_rms", "px_s", "um_s", 1, s.speed_rms_px_s);
  w.one("tau_s", 1, s.tau_s);
  w.json["tau_exceeds_tracks"] = s.persistent.tau_open;
  w.json["offset_px2"] = number(s.persistent.offset_px2);
  w.json["misfit"] = misfit_json(s.persistent_misfit);
  return w.json;
}

// One mean describes neither of several populations, and is then null.
Json speed_of(const TrackSummary& s, bool one_population, double um) {
  Writer w{Json::object(), um};
  w.json["interval_frames"] = s.interval_frames;
  w.json["interval_s"] = s.interval_s;
  w.json["displacements"] = s.speed_count;
  w.put("mean", "px_s", "um_s", 1, one_population ? s.mean_speed_px_s : Estimated{kNaN, kNaN});
  w.list("quantiles_10_50_90_px_s", "quantiles_10_50_90_um_s", s.speed_quantiles_px_s);
  w.list("histogram_edges_px_s", "histogram_edges_um_s", s.speeds_px_s.edges);
  w.json["histogram_counts"] = list_of(s.speeds_px_s.counts);
  return w.json;
}

Json turn_of(const TrackSummary& s) {
  Writer w{Json::object(), 0};
  w.json["turns"] = s.turn_count;
  w.one("mean_size_deg_s", 1, s.turn_deg_s);
  w.one("mean_signed_deg_s", 1, s.signed_turn_deg_s);
  w.json["quantiles_10_50_90_deg_s"] = list_of(s.turn_quantiles_deg_s);
  w.json["noise_deg_s"] = number(s.turn_noise_deg_s);
  return w.json;
}

}  // namespace

nlohmann::ordered_json detection_json(const TrackDetection& d) {
  const auto or_null = [](std::optional<double> v) { return v ? Json(*v) : Json(nullptr); };
  Json j{
      {"size_px", d.size_px},
      {"size_given", d.size_given},
      {"two_sizes_px", d.two_sizes ? Json{d.two_sizes->smaller_px, d.two_sizes->larger_px} : Json(nullptr)},
      {"polarity", word_of(d.polarity)},
      {"background", background_word(d)},
      {"background_frames", d.background_frames},
      {"noise_grey", d.noise_grey},
      {"threshold_snr", d.threshold_snr},
      {"threshold_given", d.threshold_given},
      {"region",
       d.region ? Json{d.region->col, d.region->row, d.region->width, d.region->height} : Json(nullptr)},
      {"spots_per_frame", d.spots_per_frame},
      {"stationary_spots", d.stationary_spots},
      {"mean_place_sd_px", or_null(d.mean_place_sd_px)},
      {"mean_elongation", or_null(d.mean_elongation)},
      {"median_snr", or_null(d.median_snr)},
      {"coding",
       {{"coded", d.coding.coded()},
        {"block_steps", d.coding.block_steps},
        {"unchanged", d.coding.unchanged}}}};
  if (d.drop) {
    j["drop_center_px"] = {d.drop->centre_image.x, d.drop->centre_image.y};
    j["drop_radius_px"] = d.drop->radius_px;
  }
  return j;
}

namespace {

Json joining_of(const TrackJoining& t) {
  return {{"reach_px", t.search_radius_px},
          {"motion", word_of(t.motion)},
          {"memory_frames", t.max_gap_frames},
          {"least_points", t.min_points},
          {"discarded_tracks", t.discarded_tracks},
          {"links_reproduced", t.reproduced ? Json(*t.reproduced) : Json(nullptr)}};
}

Json populations_of(const std::vector<SpeedPopulation>& populations, const std::optional<double>& um_per_px) {
  Json all = Json::array();
  for (const SpeedPopulation& p : populations)
    all.push_back({{"fraction", p.fraction},
                   {"speed_px_per_s", p.speed_px_s},
                   {"speed_um_per_s", um_per_px ? Json(*um_per_px * p.speed_px_s) : Json(nullptr)},
                   {"ci90", p.ci90},
                   {"motion", word_of(p.motion)},
                   {"tracks", p.tracks}});
  return all;
}

Json supported_of(const TrackSummary& s) {
  switch (supported_walk(s)) {
    case SupportedWalk::diffusion:
      return "diffusion";
    case SupportedWalk::persistent:
      return "persistent_walk";
    case SupportedWalk::none:
      break;
  }
  return nullptr;
}

Json stage_of(const StageDrift& d) {
  const bool known = d.references > 0;
  return {{"finding", word_of(d.finding)},
          {"references", d.references},
          {"drift_px_per_s", known ? number(norm(d.drift_px_s)) : Json(nullptr)},
          {"x_px_per_s", known ? number(d.drift_px_s.x) : Json(nullptr)},
          {"y_px_per_s", known ? number(d.drift_px_s.y) : Json(nullptr)},
          {"se_px_per_s", known ? number(d.drift_se_px_s) : Json(nullptr)},
          {"jitter_px", known ? number(d.jitter_px) : Json(nullptr)},
          {"removed", d.removed}};
}

Json score_of(const TrackMeasurement& m) {
  const ScoreSummary s = summary_of(m.scores);
  if (!s.mean) return nullptr;
  return {{"mean", *s.mean}, {"quantiles_10_50_90", s.quantiles}};
}

void add_summary(Json& j, const TrackSummary& s, bool one_population, double um) {
  j["tracks"] = s.tracks;
  j["points"] = s.points;
  j["mean_points"] = s.mean_points;
  j["msd"] = msd_of(s.msd);
  Writer drift{Json::object(), um};
  drift.put("x", "px_s", "um_s", 1, s.drift_x_px_s);
  drift.put("y", "px_s", "um_s", 1, s.drift_y_px_s);
  j["drift"] = s.msd.size() > 0 ? drift.json : Json(nullptr);
  j["diffusion"] = diffusion_of(s, um);
  j["persistent_walk"] = walk_of(s, um);
  j["supported"] = supported_of(s);
  Writer alpha{Json::object(), 0};
  alpha.one("persistence", 1, s.persistence);
  alpha.json["persistence_scale_s"] = number(s.persistence_scale_s);
  alpha.json["memory_frames"] = s.memory_frames;
  alpha.one("alpha", 1, s.alpha);
  j.update(alpha.json);
  j["localisation_px"] = s.msd.size() < 2 ? Json(nullptr) : number(s.localisation_px);
  j["speed"] = s.speed_count > 0 ? speed_of(s, one_population, um) : Json(nullptr);
  j["turn"] = s.turn_count > 0 ? turn_of(s) : Json(nullptr);
  j["order"] = number(s.speed_count > 0 ? s.order : std::nan(""));
  j["mean_order"] = number(mean_order(s));
}

}  // namespace

const char* word_of(Polarity p) {
  return p == Polarity::bright ? "bright" : p == Polarity::both ? "both" : "dark";
}

const char* background_word(const TrackDetection& d) { return d.temporal ? "median" : "spatial"; }

const char* word_of(Motion m) { return m == Motion::velocity ? "velocity" : "nearest"; }

nlohmann::ordered_json motion_json(const TrackSummary& summary,
                                   const std::vector<SpeedPopulation>& populations,
                                   const std::optional<double>& um_per_px) {
  Json j = Json::object();
  add_summary(j, summary, populations.size() < 2, um_per_px.value_or(0));
  j["populations"] = populations_of(populations, um_per_px);
  return j;
}

nlohmann::ordered_json track_json(const TrackMeasurement& m) {
  Json j{{"video", m.video.string()}, {"frames", m.frames}, {"duration_s", m.duration_s},
         {"frame_s", m.frame_s},      {"timed", m.timed},   {"image_size", {m.width, m.height}}};
  add_scale(j, {m.um_per_px, m.um_per_px_source, ""});
  j["detection"] = detection_json(m.detection);
  j["tracking"] = joining_of(m.joining);
  add_summary(j, m.summary, one_population(m), m.um_per_px.value_or(0));
  j["stage"] = stage_of(m.stage);
  j["track_quality"] = score_of(m);
  j["populations"] = populations_of(m.populations, m.um_per_px);
  add_quality(j, m.warnings);
  j["notes"] = m.notes;
  return j;
}

}  // namespace faba
