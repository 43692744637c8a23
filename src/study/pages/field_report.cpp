#include "study/pages/field_report.h"

#include <cmath>

#include "study/pages/quality_output.h"

namespace faba {
namespace {

using Json = nlohmann::ordered_json;

Json pair_json(Vec2 v) { return {v.x, v.y}; }

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
  j["currents_a"] = n.null.current;
  j["eigenvalues_t_per_m"] = n.null.gradient;
  j["dbz_dz_t_per_m"] = n.null.out_of_plane;
  j["reachable"] = n.null.reachable;
  j["saddle"] = n.null.saddle;
  j["note"] = n.note;
  return j;
}

Json field_json(const FieldMap& m) {
  Json j;
  j["currents_a"] = m.current;
  j["note"] = m.note;
  j["zeros"] = Json::array();
  for (const FieldMap::Zero& z : m.zeros)
    j["zeros"].push_back({{"at_m", pair_json(z.at)}, {"eigenvalues_t_per_m", z.gradient}, {"kind", z.kind}});
  j["strongest_t"] = m.strongest;
  j["table"] = nullptr;
  if (m.table)
    j["table"] = {{"spacing_m", m.table->spacing},
                  {"columns", m.table->columns},
                  {"rows", m.table->rows},
                  {"error", m.table->error}};
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
