#include "study/pages/field_report.h"

#include <cmath>

#include "study/pages/quality_output.h"

namespace faba {
namespace {

using Json = nlohmann::ordered_json;

Json pair_json(Vec2 v) { return {v.x, v.y}; }

Json zero_json(const FieldMap::Zero& z) {
  return {{"at_m", pair_json(z.at)}, {"eigenvalues_t_per_m", z.gradient}, {"kind", z.kind}};
}

Json null_json(const FieldNull& n) {
  return {{"currents_a", n.current},
          {"eigenvalues_t_per_m", n.gradient},
          {"dbz_dz_t_per_m", n.out_of_plane},
          {"reachable", n.reachable},
          {"saddle", n.saddle}};
}

Json criterion_json(const HoldStrength::Criterion& c) {
  return {{"available", c.available}, {"required", c.required}, {"met", c.met()}};
}

Json hold_json(const HoldStrength& h) {
  Json j;
  j["steering_t"] = criterion_json(h.steering);
  j["for_alignment_t"] = h.for_alignment;
  j["for_turning_t"] = h.for_turning;
  j["weakest_rad"] = h.weakest.angle;
  j["around_t"] = h.around;
  j["alignment"] = h.alignment;
  j["turning_per_s"] = h.turning;
  j["u_turn_m"] = h.u_turn;
  j["trap_t_per_m"] = criterion_json(h.trap);
  j["swarm_sd_m"] = h.swarm_sd;
  j["vertical_t"] = h.vertical;
  j["tilted"] = h.tilted;
  j["crowded"] = h.crowded;
  j["trapped"] = h.trapped();
  return j;
}

// The field of a grid for display, in nT and rounded: a short text.
Json grid_json(const std::vector<Vec3>& grid) {
  Json list = Json::array();
  const auto rounded = [](double tesla) {
    return std::isfinite(tesla) ? Json(std::llround(1e9 * tesla)) : Json();
  };
  for (const Vec3& b : grid)
    for (const double v : {b.x, b.y, b.z}) list.push_back(rounded(v));
  return list;
}

Json null_if_nan(const std::array<double, 3>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(std::isnan(v) ? Json() : Json(v));
  return list;
}

Json interval_json(double value, double error, double t95) {
  return std::isnan(error) ? Json() : Json({value - t95 * error, value + t95 * error});
}

Json intervals_json(const std::array<double, 3>& values, const std::array<double, 3>& errors, double t95) {
  Json list = Json::array();
  for (std::size_t k = 0; k < 3; ++k) list.push_back(interval_json(values[k], errors[k], t95));
  return list;
}

}  // namespace

Json field_json(const FieldAtPoints& f) {
  Json j{{"currents_a", f.current}, {"b_t", Json::array()}};
  for (const Vec3& b : f.b) j["b_t"].push_back({b.x, b.y, b.z});
  return j;
}

Json field_json(const RigNull& n) {
  Json j;
  j["at_m"] = pair_json(n.at);
  j["coils"] = n.coils;
  j.update(null_json(n.null));
  j["note"] = n.note;
  return j;
}

Json field_json(const FieldMap& m) {
  Json j;
  j["currents_a"] = m.current;
  j["note"] = m.note;
  j["zeros"] = Json::array();
  for (const FieldMap::Zero& z : m.zeros) j["zeros"].push_back(zero_json(z));
  j["strongest_t"] = m.strongest;
  j["table"] = nullptr;
  if (m.table)
    j["table"] = {{"spacing_m", m.table->spacing},
                  {"columns", m.table->columns},
                  {"rows", m.table->rows},
                  {"error", m.table->error}};
  return j;
}

Json field_json(const CoilDesign& d) {
  Json j{{"coils", d.coils}, {"limits_a", d.limit}};
  j["grids_nt"] = Json::array();
  for (const auto& grid : d.grids) j["grids_nt"].push_back(grid_json(grid));
  j["probe_t"] = {d.probe.x, d.probe.y, d.probe.z};
  j["zeros"] = Json::array();
  for (const FieldMap::Zero& z : d.zeros) j["zeros"].push_back(zero_json(z));
  j["trap"] = null_json(d.trap);
  j["inside"] = d.inside;
  j["reached"] = d.reached;
  j["hold"] = hold_json(d.hold);
  return j;
}

Json field_json(const FieldLibrarySummary& s) {
  Json j{{"out", s.out.string()}, {"combinations", s.combinations}, {"entries", s.entries},
         {"levels", s.levels},    {"columns", s.columns},           {"rows", s.rows},
         {"traps", s.traps}};
  j["null_error_m"] = nullptr;
  if (s.off) j["null_error_m"] = {{"median", s.off->median}, {"largest", s.off->largest}};
  j["strength"] = s.strength ? Json(*s.strength) : Json();
  return j;
}

Json field_json(const FieldTolerance& t) {
  Json j;
  j["at_m"] = pair_json(t.at);
  j["currents_a"] = t.current;
  j["saddle"] = t.saddle;
  j["rows"] = Json::array();
  for (const FieldTolerance::Row& r : t.rows) {
    Json row;
    row["cause"] = r.cause;
    row["words"] = r.words;
    row["amount"] = r.amount;
    row["unit"] = r.unit;
    row["lost"] = !r.shift.has_value();
    row["shift_m"] = r.shift ? Json(*r.shift) : Json();
    j["rows"].push_back(std::move(row));
  }
  return j;
}

Json field_json(const FieldFit& f) {
  Json j;
  j["values"] = f.values;
  j["gain"] = f.best.gain;
  j["gain_se"] = std::isnan(f.standard_error.gain) ? Json() : Json(f.standard_error.gain);
  j["shift_m"] = f.best.shift;
  j["shift_se_m"] = null_if_nan(f.standard_error.shift);
  j["offset_t"] = f.best.offset;
  j["offset_se_t"] = null_if_nan(f.standard_error.offset);
  j["gain_ci95"] = interval_json(f.best.gain, f.standard_error.gain, f.t95);
  j["shift_ci95_m"] = intervals_json(f.best.shift, f.standard_error.shift, f.t95);
  j["offset_ci95_t"] = intervals_json(f.best.offset, f.standard_error.offset, f.t95);
  j["rms_t"] = f.rms;
  j["rms_field_t"] = f.rms_field;
  j["undetermined"] = f.undetermined;
  j["note"] = f.warnings.empty() ? "" : sentence(f.warnings.front());
  add_quality(j, f.warnings);
  return j;
}

}  // namespace faba
