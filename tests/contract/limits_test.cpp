// The limits between controllers and coils, with the period of a camera.
#include "app/loop/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/contract/contract.h"

#include "rig/setup/coil_guard.h"

using namespace faba;
using contract::Findings;

namespace {

constexpr double kDt = 1.0 / 15;  // s, control cycle
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Limits::Params rules(std::optional<double> max_slew) {
  Limits::Params p;
  p.max_current = 1;
  p.max_slew = max_slew;
  p.max_frame_age = 0.5;
  return p;
}

bool all_zero(const std::vector<double>& current) {
  return std::all_of(current.begin(), current.end(), [](double i) { return i == 0; });
}

/// A command for two coils, and the age of its frame.
struct Requested {
  std::vector<double> current;
  double age = 0;  ///< s
};

/// Commands of a run: large, small and invalid ones, and old frames in between.
std::vector<Requested> run_of_commands() {
  std::vector<Requested> all;
  for (int i = 0; i < 40; ++i) all.push_back({{0.9, -0.9}});
  for (const double bad : {kNan, kInf, -kInf, 1e300, -1e300, 5.0, 1e-300})
    for (const double other : {0.9, -0.9, bad})
      for (const double age : {0.0, 0.5, 0.5 + kDt, 1e300, kInf, kNan}) {
        all.push_back({{bad, other}, age});
        for (int i = 0; i < 40; ++i) all.push_back({{0.9, -0.9}, i % 13 == 12 ? 2.0 : 0.0});
      }
  return all;
}

/// Contract violations of limits with parameters p. `L` has the interface of Limits.
template <class L>
Findings faults_of_limits(L&& limits, const Limits::Params& p) {
  Findings found;
  const auto add = [&](const Requested& a, const std::string& what, const Command& c) {
    found.push_back(fmt::format("{} A, {} s old: {}: {} A", fmt::join(a.current, ", "), a.age, what,
                                fmt::join(c.current, ", ")));
  };
  std::vector<double> last(2, 0.0);
  for (const Requested& a : run_of_commands()) {
    Command c{a.current};
    const bool changed = limits.apply(c, kDt, a.age);
    if (changed != (c.current != a.current)) add(a, "wrong return value", c);
    const bool old = !(a.age <= p.max_frame_age);
    if (old && !all_zero(c.current)) add(a, "current for an old frame", c);
    for (std::size_t k = 0; k < 2; ++k) {
      const double i = c.current[k];
      if (!(std::fabs(i) <= p.max_current)) add(a, "above the limit", c);
      if (!old && p.max_slew && !(std::fabs(i - last[k]) <= *p.max_slew * kDt * (1 + 1e-12)))
        add(a, "faster than max_slew", c);
    }
    last = c.current;
  }
  return found;
}

/// Deliberately faulty: no limits.
struct OpenLimits {
  bool apply(Command&, double, double) { return false; }
};
/// Deliberately faulty: applies max_slew also for an old frame.
struct RampLimits {
  Limits inner;
  bool apply(Command& c, double dt, double age) {
    const std::vector<double> asked = c.current;
    if (!(age <= 0.5)) c.current.assign(c.current.size(), 0.0);
    inner.apply(c, dt, 0);
    return c.current != asked;
  }
};

bool mentions(const Findings& all, const std::string& what) {
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& f) { return f.find(what) != std::string::npos; });
}

}  // namespace

TEST_CASE("limits: current and slew rate are limited, and old frames give zero at once, for all requests") {
  for (const std::optional<double> slew : {std::optional<double>{}, std::optional<double>{0.5}}) {
    INFO("max_slew ", slew.value_or(0));
    CHECK_NO_FINDINGS(faults_of_limits(Limits(rules(slew)), rules(slew)));
  }
}

TEST_CASE("deliberately faulty limits are detected") {
  const Findings open = faults_of_limits(OpenLimits{}, rules(0.5));
  for (const char* what : {"above the limit", "faster than max_slew", "current for an old frame"}) {
    INFO(what);
    CHECK(mentions(open, what));
  }
  const Findings ramp = faults_of_limits(RampLimits{Limits(rules(0.5))}, rules(0.5));
  CHECK(mentions(ramp, "current for an old frame"));
  CHECK_FALSE(mentions(ramp, "above the limit"));
}

TEST_CASE("limits: zero within one cycle after an old frame, then the slew rate limit applies again") {
  Limits limits(rules(0.3));
  Command c;
  for (int i = 0; i < 60; ++i) limits.apply(c = {{0.9, -0.6}}, kDt, 0);
  CHECK(c.current == std::vector<double>{0.9, -0.6});
  CHECK(limits.apply(c = {{0.9, -0.6}}, kDt, 0.6));
  CHECK(c.current == std::vector<double>{0, 0});
  CHECK(limits.apply(c = {{0.9, -0.6}}, kDt, 0));
  CHECK(c.current[0] == doctest::Approx(0.3 * kDt));
  CHECK(c.current[1] == doctest::Approx(-0.3 * kDt));
}

TEST_CASE("limits and the guard of a bench agree: commands that pass the limits never trip the guard") {
  const Limits::Params p = rules(0.5);
  CoilGuard::Params g;
  g.max_slew = p.max_slew;
  CoilGuard guard(g, {{1, 1}, {1, 1}}, kDt);
  Limits limits(p);
  guard.arm(0);
  double t = 0;
  std::uint64_t number = 0;
  for (const Requested& a : run_of_commands()) {
    t += kDt;
    Command c{a.current};
    limits.apply(c, kDt, a.age);
    guard.heartbeat(t);
    guard.take({++number, t, t, c.current}, t);
    REQUIRE_MESSAGE(guard.state() == CoilGuard::State::armed, guard.reason());
    CHECK(guard.current() == c.current);
  }
}
