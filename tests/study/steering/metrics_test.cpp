#include "study/steering/metric_list.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec.h"
#include "study/data/series.h"

namespace {

using faba::Vec2;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Vec2 kNowhere{kNan, kNan};

/// A series built frame by frame, with the columns of a run.
struct Recording {
  std::vector<double> t, x, y, d, setpoint_x, setpoint_y;

  void frame(double t_s, Vec2 centroid, Vec2 setpoint) {
    t.push_back(t_s);
    x.push_back(centroid.x);
    y.push_back(centroid.y);
    setpoint_x.push_back(setpoint.x);
    setpoint_y.push_back(setpoint.y);
    d.push_back(faba::norm(centroid - setpoint));
  }
  faba::Series series() const {
    const std::vector<double> sx(t.size(), 3), sy(t.size(), 4), r(t.size(), 5);
    return {"series.csv",
            {"t_s", "true_centroid_x_px", "true_centroid_y_px", "true_sigma_x_px", "true_sigma_y_px",
             "true_rms_radius_px", "distance_px", "setpoint_x_px", "setpoint_y_px"},
            {t, x, y, sx, sy, r, d, setpoint_x, setpoint_y}};
  }
  /// The same with further columns.
  faba::Series with(std::vector<std::string> names, std::vector<std::vector<double>> columns) const {
    const faba::Series base = series();
    for (const std::string& name : base.names()) {
      names.push_back(name);
      columns.emplace_back(base.column(name).begin(), base.column(name).end());
    }
    return {"series.csv", names, columns};
  }
};

/// n frames with a period of dt, on the straight line from (20, 50) to the setpoint (340, 290), 400 px away.
/// The remaining distance is `rest(t)` times 400 px (negative beyond the setpoint). A 3-4-5 triangle reveals
/// exchanged x and y.
Recording approach(std::size_t n, double dt, const std::function<double(double)>& rest) {
  Recording r;
  for (std::size_t k = 0; k < n; ++k) {
    const double left = rest(double(k) * dt);
    r.frame(double(k) * dt, {340 - 320 * left, 290 - 240 * left}, {340, 290});
  }
  return r;
}

}  // namespace

TEST_CASE("metrics: exponential approach: settling time, rise time and integrals agree with the formula") {
  const double tau = 1.7, dt = 1.0 / 15, d0 = 400;
  const std::size_t n = 301;
  const double end = double(n - 1) * dt;
  const faba::Metrics m =
      control_metrics(approach(n, dt, [&](double t) { return std::exp(-t / tau); }).series());

  CHECK(m.frames == n);
  CHECK(m.setpoints == 1);
  CHECK(m.duration_s == doctest::Approx(end));
  CHECK(*m.initial_error_px == doctest::Approx(d0));
  CHECK(*m.settling_band_px == doctest::Approx(0.05 * d0));
  // The first frame at or after tau ln 20.
  CHECK(*m.settling_time_s == doctest::Approx(dt * std::ceil(tau * std::log(20.0) / dt)).epsilon(1e-12));
  // A chord is above a convex curve by at most d'' dt^2 / 8; each crossing is late by at most that over |d'|
  // at the end of its frame interval: dt^2 exp(dt/tau) / (8 tau).
  const double late = dt * dt * std::exp(dt / tau) / (8 * tau);
  CHECK(std::abs(*m.rise_time_s - tau * std::log(9.0)) <= late);
  CHECK(*m.overshoot_percent == 0);
  // A convex integrand is overestimated by at most dt^2 / 8 times the integral of d'', which is d0 / tau.
  const double iae = d0 * tau * (1 - std::exp(-end / tau));
  CHECK(*m.iae_px_s >= iae);
  CHECK(*m.iae_px_s <= iae + dt * dt / 8 * d0 / tau);
  // The error of the trapezoidal rule is at most dt^2 / 8 times the integral of |f''|, which for
  // f = d0 t e^{-t/tau} is below d0 times that of (t / tau^2 + 2 / tau) e^{-t/tau}, or 3 d0.
  const double itae = d0 * tau * (tau - (end + tau) * std::exp(-end / tau));
  CHECK(std::abs(*m.itae_px_s2 - itae) <= 3 * d0 * dt * dt / 8);
  // Frames 200 to 300: a geometric series.
  const double q = std::exp(-2 * dt / tau);
  const double mean = d0 * d0 * std::pow(q, 200) * (1 - std::pow(q, 101)) / (1 - q) / 101;
  CHECK(*m.steady_rms_px == doctest::Approx(std::sqrt(mean)).epsilon(1e-9));
  CHECK(*m.path_length_px == doctest::Approx(d0 * (1 - std::exp(-end / tau))));
  CHECK_FALSE(m.cross_track_rms_px);
}

TEST_CASE("metrics: the settling band is 10 px when 5 % of the initial error is smaller") {
  Recording r;
  for (int k = 0; k <= 10; ++k) r.frame(k, {100.0 - 10 * k + 2, 40}, {2, 40});  // 100, 90, ... 0 px
  const faba::Metrics m = control_metrics(r.series());
  CHECK(*m.settling_band_px == 10);
  CHECK(*m.settling_time_s == 9);  // the band includes its edge
}

TEST_CASE("metrics: damped oscillation: overshoot exp(-a pi / w), settling time of its envelope") {
  const double a = 0.6, w = 2.5, dt = 0.01;
  const auto rest = [&](double t) { return std::exp(-a * t) * (std::cos(w * t) + a / w * std::sin(w * t)); };
  const faba::Metrics m = control_metrics(approach(1001, dt, rest).series());
  const double peak = std::exp(-a * std::numbers::pi / w);
  // A frame is at most dt/2 from the peak, where the second derivative is (a^2 + w^2) times the peak.
  const double missed = peak * (a * a + w * w) * dt * dt / 8;
  CHECK(*m.overshoot_percent <= 100 * peak);
  CHECK(*m.overshoot_percent >= 100 * (peak - missed) * (1 - 1e-6));
  // By definition: no later value is outside the band, and the frame before is outside.
  const double settled = *m.settling_time_s;
  CHECK(std::abs(rest(settled - dt)) > 0.05);
  for (double t = settled; t < 10; t += dt) CHECK(std::abs(rest(t)) <= 0.05 + 1e-12);
  CHECK(settled > 3.0);  // the first entry, near t = 0.8 s, is not the last one
  CHECK(*m.rise_time_s < 1.0);
}

TEST_CASE("metrics: no settling time when the swarm leaves the band again") {
  const auto leaves = [](double t) { return t < 5 ? 1 - t / 5 : (t - 5) / 5; };
  const faba::Metrics m = control_metrics(approach(101, 0.1, leaves).series());
  CHECK_FALSE(m.settling_time_s);
  CHECK(*m.final_distance_px == doctest::Approx(400));
  CHECK(m.rise_time_s);  // 10 % was reached
  const nlohmann::ordered_json j = metrics_json(m);
  CHECK(j["settling_time_s"].is_null());
  CHECK(j["steady_rms_px"].is_number());
}

TEST_CASE("metrics: no rise time when the swarm does not approach the setpoint") {
  const faba::Metrics m = control_metrics(approach(50, 0.1, [](double) { return 1.0; }).series());
  CHECK_FALSE(m.settling_time_s);
  CHECK_FALSE(m.rise_time_s);
  CHECK(*m.overshoot_percent == 0);
  CHECK(*m.steady_rms_px == doctest::Approx(400));
  CHECK(*m.iae_px_s == doctest::Approx(400 * 4.9));
  CHECK(*m.itae_px_s2 == doctest::Approx(400 * 4.9 * 4.9 / 2));
  CHECK(*m.path_length_px == 0);
}

TEST_CASE("metrics: one frame") {
  Recording near, far;
  near.frame(2, {100, 50}, {103, 54});
  far.frame(2, {100, 50}, {130, 90});
  const faba::Metrics m = control_metrics(near.series()), f = control_metrics(far.series());
  CHECK(m.frames == 1);
  CHECK(m.duration_s == 0);
  CHECK(*m.settling_time_s == 0);
  CHECK(*m.steady_rms_px == doctest::Approx(5));
  CHECK_FALSE(m.iae_px_s);
  CHECK_FALSE(m.path_length_px);
  CHECK_FALSE(m.rise_time_s);
  CHECK_FALSE(m.overshoot_percent);
  CHECK(*m.sigma_x_px == 3);
  CHECK(*m.sigma_y_px == 4);
  CHECK_FALSE(f.settling_time_s);
  CHECK(*f.steady_rms_px == doctest::Approx(50));
}

TEST_CASE("metrics: no frames") {
  const faba::Metrics m = control_metrics(Recording().series());
  CHECK(m.frames == 0);
  CHECK_FALSE(m.steady_rms_px);
  CHECK(metrics_json(m)["dispersion_px"].dump() == "[null,null]");
}

TEST_CASE("metrics: without a target there is no error, but dispersion and path length") {
  Recording r;
  for (int k = 0; k < 5; ++k) r.frame(0.5 * k, {10.0 + 3 * k, 20.0 + 4 * k}, kNowhere);
  const faba::Metrics m = control_metrics(r.series());
  CHECK(m.setpoints == 0);
  CHECK_FALSE(m.setpoints_reached);
  CHECK(metrics_json(m)["setpoints_reached"].dump() == "0");
  CHECK_FALSE(m.initial_error_px);
  CHECK_FALSE(m.settling_time_s);
  CHECK_FALSE(m.steady_rms_px);
  CHECK_FALSE(m.overshoot_percent);
  CHECK(*m.path_length_px == doctest::Approx(20));
  CHECK(*m.rms_radius_px == 5);
}

TEST_CASE("metrics: times start at the first targeted frame, gaps are ignored") {
  Recording r;
  for (int k = 0; k < 3; ++k) r.frame(k, {0, 10}, kNowhere);
  for (int k = 3; k < 9; ++k) r.frame(k, {20.0 * (k - 3), 10}, k == 5 ? kNowhere : Vec2{100, 10});
  const faba::Metrics m = control_metrics(r.series());
  CHECK(m.setpoints == 1);  // the same one after the gap
  CHECK(*m.initial_error_px == 100);
  CHECK(*m.settling_time_s == 5);  // d = 100 80 - 40 20 0 from frame 3, in the band at frame 8
  CHECK(*m.rise_time_s == doctest::Approx(4.5 - 0.5));  // 90 px between frames 3 and 4, 10 px between 7 and 8
  CHECK(*m.iae_px_s == doctest::Approx(90 + 30 + 10));  // without the intervals next to the gap
  CHECK(*m.itae_px_s2 == doctest::Approx(40 + (120 + 80) / 2 + 40));
  CHECK(*m.steady_rms_px == doctest::Approx(std::sqrt((1600.0 + 400 + 0) / 3)));
}

TEST_CASE("metrics: the last third is 2 of 4 frames, and 134 of 400") {
  Recording four, many;
  for (int k = 0; k < 4; ++k) four.frame(k, {0, 0}, {k < 2 ? 1000.0 : 6.0, 8});
  for (int k = 0; k < 400; ++k) many.frame(k, {0, 0}, {k < 266 ? 1000.0 : 6.0, 8});
  CHECK(*control_metrics(four.series()).steady_rms_px == doctest::Approx(10));
  CHECK(*control_metrics(many.series()).steady_rms_px == doctest::Approx(10));
}

TEST_CASE("metrics: no overshoot and no rise time when the swarm starts at its setpoint") {
  const faba::Metrics m =
      control_metrics(approach(30, 0.1, [](double t) { return 0.01 * std::cos(9 * t); }).series());
  CHECK(*m.initial_error_px == doctest::Approx(4));
  CHECK(*m.settling_time_s == 0);
  CHECK_FALSE(m.rise_time_s);
  CHECK_FALSE(m.overshoot_percent);
}

TEST_CASE("metrics: a setpoint is reached when a frame of its leg is within tolerance or settling band") {
  Recording r;
  const std::pair<Vec2, Vec2> frames[] = {{{0, 0}, {100, 0}},      {{95, 0}, {100, 0}},      // 5 px
                                          {{100, 20}, {100, 100}}, {{100, 85}, {100, 100}},  // 15 px
                                          {{100, 85}, {0, 100}},   {{60, 85}, {0, 100}},
                                          {{60, 85}, {100, 0}},    {{95, 5}, {100, 0}}};  // again, 7.1 px
  for (std::size_t k = 0; k < std::size(frames); ++k) r.frame(double(k), frames[k].first, frames[k].second);
  const faba::Series s = r.series();
  CHECK(control_metrics(s).setpoints == 4);
  CHECK(*control_metrics(s).setpoints_reached == 2);  // band: 10 px
  CHECK(*control_metrics(s, 15).setpoints_reached == 3);
  CHECK(*control_metrics(s, 6).setpoints_reached == 1);
  CHECK(*control_metrics(s, 1).setpoints_reached == 0);
  CHECK(metrics_json(control_metrics(s))["setpoints_reached"].dump() == "2");
}

TEST_CASE("metrics: a run that ended before the last setpoint of its route is not settled") {
  const faba::Series s = approach(50, 0.1, [](double t) { return t < 2 ? 1.0 : 0.0; }).series();
  CHECK(*control_metrics(s).settling_time_s == doctest::Approx(2));
  CHECK(*control_metrics(s, 10, 1).settling_time_s == doctest::Approx(2));
  CHECK_FALSE(control_metrics(s, 10, 4).settling_time_s);
  CHECK(control_metrics(s, 10, 4).route_unfinished());
  CHECK(control_metrics(s, 10, 900).settling_time_s);  // a moving setpoint has no last one
}

TEST_CASE("metrics: the cross-track error is the distance to the polyline of setpoints") {
  // A route with a corner, followed at a distance of 3 px on its first leg and 1 px on the second. The
  // approach before the first change of the setpoint is excluded.
  const std::vector<Vec2> corner{{100, 60}, {300, 60}, {300, 160}};
  Recording r;
  double t = 0;
  for (int k = 0; k < 10; ++k) r.frame(t++, {5.0 * k, 400}, corner[0]);
  for (int k = 0; k <= 18; ++k) r.frame(t++, {110.0 + 10 * k, 63}, corner[1]);
  for (int k = 0; k < 76; ++k) r.frame(t++, {301, 65.0 + k}, corner[2]);
  const faba::Metrics m = control_metrics(r.series());
  CHECK(m.setpoints == 3);
  CHECK(*m.cross_track_rms_px == doctest::Approx(std::sqrt((19 * 9.0 + 76 * 1.0) / 95)));
  CHECK(*m.cross_track_95_px == doctest::Approx(3));
}

TEST_CASE("metrics: cross-track error for a long moving setpoint equals that of a brute-force search") {
  // 700 different setpoints on a Lissajous curve with crossings, so that the nearest segment changes often.
  const auto curve = [](double s) { return Vec2{320 + 300 * std::sin(3 * s), 240 + 200 * std::sin(2 * s)}; };
  Recording r;
  std::vector<Vec2> vertex, centroid;
  for (int k = 0; k < 700; ++k) {
    vertex.push_back(curve(0.01 * k));
    centroid.push_back(curve(0.01 * k - 0.2) + Vec2{12 * std::sin(1.7 * k), 9 * std::cos(2.3 * k)});
    r.frame(k / 15.0, centroid.back(), vertex.back());
  }
  double square = 0;
  for (std::size_t k = 1; k < centroid.size(); ++k) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < vertex.size(); ++i) {
      const Vec2 a = vertex[i - 1], ab = vertex[i] - a;
      const double along = std::min(1.0, std::max(0.0, dot(centroid[k] - a, ab) / dot(ab, ab)));
      best = std::min(best, norm(centroid[k] - (a + along * ab)));
    }
    square += best * best;
  }
  const faba::Metrics m = control_metrics(r.series());
  CHECK(m.setpoints == 700);
  CHECK(*m.cross_track_rms_px == doctest::Approx(std::sqrt(square / 699)).epsilon(1e-12));
}

TEST_CASE("metrics: overshoot and rise time depend on the first setpoint only") {
  Recording r;
  for (int k = 0; k <= 20; ++k) r.frame(k, {10.0 * k, 30}, {160, 30});  // 25 % beyond
  for (int k = 21; k < 60; ++k) r.frame(k, {200.0 + 40 * (k - 20), 30}, {210, 30});
  const faba::Metrics m = control_metrics(r.series());
  CHECK(*m.overshoot_percent == doctest::Approx(25));
  CHECK(*m.rise_time_s == doctest::Approx(0.8 * 16));
  CHECK_FALSE(m.settling_time_s);

  Recording short_leg;  // the setpoint changes halfway, to the present position
  for (int k = 0; k <= 8; ++k) short_leg.frame(k, {10.0 * k, 30}, {160, 30});
  for (int k = 9; k < 60; ++k) short_leg.frame(k, {80, 30}, {80, 30});
  CHECK_FALSE(control_metrics(short_leg.series()).rise_time_s);
}

TEST_CASE("metrics: effort and variation of the command") {
  const Recording r = approach(5, 0.5, [](double) { return 1.0; });
  // Constant between frames: 0.5 s * (1 + 4 + 4 + 0) and 0.5 s * 4 * 0.25; the last frame is not counted in
  // the effort.
  const std::vector<double> i0{1, 2, -2, 0, 9}, i1{0.5, 0.5, 0.5, 0.5, 0.5};
  const std::vector<double> bx{0, 3, 3, 3, 0}, by{0, 4, 4, 4, 0}, limited{0, 1, 1, 0, kNan};
  const faba::Metrics m = control_metrics(r.with(
      {"current_0_a", "current_1_a", "field_x_ut", "field_y_ut", "limited"}, {i0, i1, bx, by, limited}));
  CHECK(*m.control_effort_a2_s == doctest::Approx(4.5 + 0.5));
  CHECK(*m.total_variation_a == doctest::Approx(1 + 4 + 2 + 9));
  CHECK(*m.total_variation_ut == doctest::Approx(10));
  CHECK(*m.limited_fraction == doctest::Approx(0.5));

  const faba::Metrics none = control_metrics(r.series());
  CHECK_FALSE(none.control_effort_a2_s);
  CHECK_FALSE(none.total_variation_a);
  CHECK_FALSE(none.total_variation_ut);
  CHECK_FALSE(none.limited_fraction);
}

TEST_CASE("metrics: the columns after distance_px are optional") {
  const faba::Series s(
      "series.csv",
      {"frame", "t_s", "true_centroid_x_px", "true_centroid_y_px", "true_sigma_x_px", "true_sigma_y_px",
       "true_rms_radius_px", "distance_px"},
      {{0, 1, 2}, {0, 1, 2}, {0, 50, 99}, {7, 7, 7}, {1, 2, 3}, {4, 5, 6}, {5, 6, 7}, {100, 50, 1}});
  const faba::Metrics m = control_metrics(s);
  CHECK(m.setpoints == 1);
  CHECK(*m.settling_time_s == 2);
  CHECK_FALSE(m.overshoot_percent);
  const nlohmann::ordered_json j = metrics_json(m);
  CHECK(j["settling_time_s"] == 2);
  CHECK(j["steady_rms_px"] == 1);
  CHECK(j["dispersion_px"] == nlohmann::ordered_json::array({3, 6}));
  CHECK(j["frames"] == 3);
  CHECK(j["overshoot_percent"].is_null());
}

TEST_CASE("metrics: errors for a missing column and for times that do not increase name the line") {
  const auto where = [](const faba::Series& s) {
    try {
      static_cast<void>(control_metrics(s));
    } catch (const faba::Error& e) {
      return e.code() == faba::Errc::input ? e.where() : "wrong code";
    }
    return std::string("no exception");
  };
  CHECK(where(faba::Series("series.csv", {"t_s"}, {{0}})) == "series.csv:1");
  Recording r = approach(5, 0.1, [](double) { return 1.0; });
  r.t[3] = r.t[2];
  CHECK(where(r.series()) == "series.csv:5");
  r.t[3] = kNan;
  CHECK(where(r.series()) == "series.csv:5");
}
