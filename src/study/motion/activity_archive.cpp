#include "study/motion/activity_archive.h"

namespace faba {
namespace {

// `fields`: archives the value.
template <class T, class Fields>
void archive_optional(Archive& a, std::optional<T>& value, Fields&& fields) {
  bool present = value.has_value();
  a& present;
  if (!present) return;
  if (!value) value.emplace();
  fields(*value);
}

void archive_optional(Archive& a, std::optional<double>& value) {
  archive_optional(a, value, [&](double& v) { a& v; });
}

void archive_measured(Archive& a, Measured& m) { a& m.value& m.ci90[0] & m.ci90[1]; }

void archive_fit(Archive& a, GaussianFit& f) {
  a& f.amplitude& f.peak_s& f.sigma_s& f.offset;
  a& f.se_amplitude& f.se_peak_s& f.se_sigma_s& f.se_offset;
  a& f.scatter& f.good& f.reason;
}

void archive_flow(Archive& a, FlowVerdict& v) {
  a& v.shift_px& v.object_px;
  archive_optional(a, v.neighbour_px);
}

void archive_response(Archive& a, Response& r) {
  a& r.source& r.earliest_s& r.direction_deg& r.measure& r.responds;
  ChangePoint& c = r.change;
  a& c.t_s& c.ci90[0] & c.ci90[1] & c.before& c.after& c.t_statistic& c.rise_s;
  a& r.fraction_method;
  archive_optional(a, r.fraction, [&](Measured& m) { archive_measured(a, m); });
  archive_optional(a, r.speed_px_s, [&](Measured& m) { archive_measured(a, m); });
  archive_optional(a, r.flow, [&](FlowVerdict& v) { archive_flow(a, v); });
  a& r.still_at_edge;
}

template <class T, class Fields>
void archive_list(Archive& a, std::vector<T>& list, Fields&& fields) {
  std::uint64_t n = list.size();
  a& n;
  for (std::uint64_t i = 0; i < n; ++i) {
    if (a.reading()) list.emplace_back();
    fields(list[i]);
  }
}

}  // namespace

void archive_activity(Archive& a, VideoActivity& v) {
  archive_optional(a, v.scale.um_per_px);
  archive_optional(a, v.scale.standard_error);
  a& v.scale.source& v.scale.ignored& v.signature& v.threshold_px& v.direction_deg& v.direction_given;
  archive_list(a, v.segments, [&](MotionSegment& s) { a& s.t0_s& s.t1_s& s.direction_deg; });
  a& v.t_s& v.amount& v.along& v.mean_amount& v.mean_along& v.timed& v.frame_s;
  archive_optional(a, v.visible_cells);
  archive_fit(a, v.fit);
  archive_optional(a, v.maximum_s);
  archive_optional(a, v.departure_s);
  archive_optional(a, v.response, [&](Response& r) { archive_response(a, r); });
  a& v.view_px;
  archive_optional(a, v.um_per_px);
  archive_optional(a, v.signal_to_noise);
  a& v.responds& v.busiest_deg;
  archive_list(a, v.warnings, [&](Warning& w) { a& w.aspect& w.what& w.evidence& w.advice& w.quality; });
  a& v.notes;
}

}  // namespace faba
