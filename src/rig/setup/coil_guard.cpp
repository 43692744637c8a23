#include "rig/setup/coil_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace faba {
namespace {

constexpr double kWithin = 0.1, kFrames = 2;  // s and frames; all current must be zero within the larger one
constexpr double kReaction = 0.03;            // s, reaction time of the guard, its device and a coil's L/R
constexpr double kRound = 1 + 1e-6;           // rounding of time differences, 5e-10 s after a month of uptime

const char* fault_text(CoilGuard::Fault f) {
  using enum CoilGuard::Fault;
  switch (f) {
    case none:
      return "";
    case not_finite:
      return "invalid command";
    case over_current:
      return "current limit exceeded";
    case over_slew:
      return "slew rate limit exceeded";
    case thermal_limit:
      return "thermal limit exceeded";
    case stale:
      return "stale command";
    case out_of_order:
      return "out-of-order command";
    case command_timeout:
      return "command timeout";
    case heartbeat_timeout:
      return "heartbeat timeout";
    case disconnected:
      return "client disconnected";
    case signal:
      return "the guard was terminated by a signal";
    case current_mismatch:
      return "sensed current differs from commanded current";
    case device:
      return "device error";
  }
  return "";
}

}  // namespace

Schema<CoilGuard::Params> CoilGuard::schema() {
  return Schema<Params>("guard", "Limits and timeouts at which the guard trips and de-energises the coils")
      .add("command_deadline", &Params::command_deadline,
           {.unit = "s",
            .min = 1e-3,
            .max = 10,
            .doc = "Command timeout; default: a value with which the current is zero within 100 ms or two "
                   "frames of the last command, whichever is longer"})
      .add("heartbeat_deadline", &Params::heartbeat_deadline,
           {.unit = "s",
            .min = 5e-3,
            .max = 1,
            .doc = "Heartbeat timeout",
            .source = "100 ms minus the reaction time of device and coil"})
      .add("max_slew", &Params::max_slew,
           {.unit = "A/s",
            .min = 1e-6,
            .max = 1e9,
            .doc = "Maximum slew rate of any current; default: unlimited"})
      .add("thermal_time", &Params::thermal_time,
           {.unit = "s",
            .min = 0.1,
            .max = 1e5,
            .doc = "Thermal time constant of a coil: the square of its current is averaged over it",
            .source = "assumed"})
      .add("sense_tolerance", &Params::sense_tolerance,
           {.unit = "A",
            .min = 1e-6,
            .max = 1e3,
            .doc = "Maximum difference between sensed and commanded current"})
      .add("sense_settling", &Params::sense_settling,
           {.unit = "s", .min = 0, .max = 10, .doc = "Settling time of a current"})
      .add("sense_samples", &Params::sense_samples,
           {.min = 1, .max = 1e6, .doc = "Consecutive samples above the tolerance that trip the guard"});
}

CoilGuard::CoilGuard(const Params& p, std::vector<Bounds> coils, double frame_period)
    : p_(p),
      coils_(std::move(coils)),
      frame_period_(frame_period),
      current_(coils_.size(), 0.0),
      heat_(coils_.size(), 0.0) {
  if (!p_.command_deadline) p_.command_deadline = std::max(kWithin, kFrames * frame_period) - kReaction;
}

bool CoilGuard::arm(double now) {
  if (state_ != State::disarmed) return state_ == State::armed;
  update_heat(now);
  state_ = State::armed;
  last_command_ = last_heartbeat_ = now;
  last_frame_t_.reset();
  return true;
}

void CoilGuard::disarm(double now) {
  set_current(std::vector<double>(coils_.size(), 0.0), now);
  if (state_ == State::armed) state_ = State::disarmed;
}

void CoilGuard::reset() {
  if (state_ != State::tripped) return;
  state_ = State::disarmed;
  fault_ = Fault::none;
  reason_.clear();
  mismatches_ = 0;
}

CoilGuard::Fault CoilGuard::violation(const Request& r, double now, std::string& detail) const {
  if (last_number_ && r.number <= *last_number_) {
    detail = fmt::format("command {} after command {}", r.number, *last_number_);
    return Fault::out_of_order;
  }
  if (const double age = now - r.sent; !(age <= *p_.command_deadline && age > -*p_.command_deadline)) {
    detail = fmt::format("{:.0f} ms old", 1e3 * age);
    return Fault::stale;
  }
  if (r.current.size() != coils_.size()) {
    detail = fmt::format("{} currents for {} coils", r.current.size(), coils_.size());
    return Fault::not_finite;
  }
  const bool zero = std::all_of(r.current.begin(), r.current.end(), [](double i) { return i == 0; });
  if (zero) return Fault::none;  // zero current is always allowed, at any slew rate
  if (!std::isfinite(r.frame_t)) {
    detail = "frame time is not finite";
    return Fault::not_finite;
  }
  for (std::size_t k = 0; k < coils_.size(); ++k) {
    const double i = r.current[k];
    if (!std::isfinite(i)) {
      detail = fmt::format("coil {}: current is not finite", k);
      return Fault::not_finite;
    }
    if (std::fabs(i) > coils_[k].max_current * kRound) {
      detail = fmt::format("coil {}: {:g} A; at most {:g} A", k, i, coils_[k].max_current);
      return Fault::over_current;
    }
    if (!p_.max_slew) continue;
    const double dt = last_frame_t_ ? r.frame_t - *last_frame_t_ : frame_period_;
    const double most = *p_.max_slew * std::max(0.0, dt) * kRound;
    if (std::fabs(i - current_[k]) > most) {
      detail = fmt::format("coil {}: change of {:g} A; at most {:g} A between these frames", k,
                           i - current_[k], most);
      return Fault::over_slew;
    }
  }
  return Fault::none;
}

void CoilGuard::take(const Request& r, double now) {
  if (state_ != State::armed) return;
  std::string detail;
  if (const Fault f = violation(r, now, detail); f != Fault::none) {
    ++refused_;
    fail(f, detail, now);
    return;
  }
  ++passed_;
  last_number_ = r.number;
  last_command_ = now;
  if (std::isfinite(r.frame_t)) last_frame_t_ = r.frame_t;
  set_current({r.current.begin(), r.current.end()}, now);
}

void CoilGuard::set_current(std::vector<double> current, double now) {
  update_heat(now);
  if (current == current_) return;
  while (recent_.size() > 1 && recent_[1].t < now - p_.sense_settling) recent_.pop_front();
  recent_.push_back({now, current_});  // flowed until now
  current_ = std::move(current);
}

void CoilGuard::sensed(std::span<const double> current, double now) {
  bool off = false;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < coils_.size() && k < current.size(); ++k) {
    if (std::isnan(current[k])) continue;
    double low = current_[k], high = current_[k];
    for (const Previous& p : recent_)
      if (p.t >= now - p_.sense_settling) {
        low = std::min(low, p.current[k]);
        high = std::max(high, p.current[k]);
      }
    if (current[k] >= low - p_.sense_tolerance && current[k] <= high + p_.sense_tolerance) continue;
    off = true;
    worst = k;
  }
  mismatches_ = off ? mismatches_ + 1 : 0;
  if (mismatches_ >= p_.sense_samples)
    fail(Fault::current_mismatch,
         fmt::format("coil {}: {:.3g} A instead of {:.3g} A", worst, current[worst], current_[worst]), now);
}

void CoilGuard::update_heat(double now) {
  const double weight = -std::expm1(-std::max(0.0, now - now_) / p_.thermal_time);
  for (std::size_t k = 0; k < coils_.size(); ++k) heat_[k] += weight * (current_[k] * current_[k] - heat_[k]);
  now_ = std::max(now, now_);
}

double CoilGuard::heat_of(std::size_t k) const {
  return heat_[k] > 0 ? heat_[k] / (coils_[k].max_rms * coils_[k].max_rms) : 0;
}

std::size_t CoilGuard::warmest() const {
  std::size_t most = 0;
  for (std::size_t k = 1; k < coils_.size(); ++k)
    if (heat_of(k) > heat_of(most)) most = k;
  return most;
}

double CoilGuard::heat() const { return coils_.empty() ? 0 : heat_of(warmest()); }

void CoilGuard::check(double now) {
  update_heat(now);
  if (state_ != State::armed || !energised()) return;  // zero current needs no timeout
  if (now - last_heartbeat_ > p_.heartbeat_deadline)
    fail(Fault::heartbeat_timeout, fmt::format("no heartbeat for {:.0f} ms", 1e3 * (now - last_heartbeat_)),
         now);
  else if (now - last_command_ > *p_.command_deadline)
    fail(Fault::command_timeout, fmt::format("no new command for {:.0f} ms", 1e3 * (now - last_command_)),
         now);
  else if (heat() > 1)
    fail(Fault::thermal_limit,
         fmt::format("coil {}: root mean square current over {:g} s is above {:g} A", warmest(),
                     p_.thermal_time, coils_[warmest()].max_rms),
         now);
}

bool CoilGuard::energised() const {
  return std::any_of(current_.begin(), current_.end(), [](double i) { return i != 0; });
}

double CoilGuard::due() const {
  if (!energised()) return std::numeric_limits<double>::infinity();
  return std::min(last_heartbeat_ + p_.heartbeat_deadline, last_command_ + *p_.command_deadline);
}

void CoilGuard::fail(Fault f, const std::string& detail, double now) {
  set_current(std::vector<double>(coils_.size(), 0.0), now);
  if (state_ == State::tripped) return;
  state_ = State::tripped;
  fault_ = f;
  reason_ = detail.empty() ? fault_text(f) : fmt::format("{} ({})", fault_text(f), detail);
}

const char* word(CoilGuard::State s) {
  using enum CoilGuard::State;
  return s == disarmed ? "disarmed" : s == armed ? "armed" : "tripped";
}

const char* word(CoilGuard::Fault f) {
  constexpr const char* kWords[] = {
      "none",   "not_finite",       "over_current",    "over_slew",         "thermal_limit",
      "stale",  "out_of_order",     "command_timeout", "heartbeat_timeout", "disconnected",
      "signal", "current_mismatch", "device"};
  return kWords[std::size_t(f)];
}

}  // namespace faba
