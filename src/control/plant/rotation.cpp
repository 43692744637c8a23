#include "control/plant/rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/portable_math.h"
#include "field/allocate.h"

namespace faba {
namespace {

using Response = SwarmMotion::Response;
using portable::kPi;

constexpr double kDefaultFrequency = 5;  // Hz
// The default leaves room for cells that turn at half the rate of a typical one.
constexpr double kDefaultStepOut = 0.5;
constexpr double kMostStepOut = 0.9;  // of w_B; the bias must not break the lock
constexpr double kFramesPerTurn =
    8;  // with 8, the first harmonic of the held field is 0.974 of its magnitude
constexpr double kLargestPhase = 1000;  // rad; within the range of portable::sincos

double harmonic(double half_angle) {
  return half_angle == 0 ? 1 : double(portable::sincos(float(half_angle)).sin) / half_angle;
}

/// The largest field in the plane, T, that the coils make in every direction at the centre of the arena.
double reach(const ControlContext& c) {
  const std::vector<double> x = allocate(*c.field, {}, {1, 0}), y = allocate(*c.field, {}, {0, 1});
  Vec2 made_x, made_y;
  std::vector<Vec3> b(c.field->coils());
  c.field->basis({}, b, {});
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < b.size(); ++k) {
    made_x = made_x + x[k] * Vec2{b[k].x, b[k].y};
    made_y = made_y + y[k] * Vec2{b[k].x, b[k].y};
    const double per_tesla = norm(Vec2{x[k], y[k]});
    if (k < c.max_current.size() && per_tesla > 0) most = std::min(most, c.max_current[k] / per_tesla);
  }
  constexpr double kMade = 0.5;  // of the wanted field; coils along one axis make none along the other
  if (!(made_x.x > kMade) || !(made_y.y > kMade)) return 0;
  return most;
}

double checked_strength(const RotationParams& p, double preset, const ControlContext& c) {
  const Vec3 ambient = c.field->ambient();
  const double all = reach(c);
  const double most = std::max(0.0, all - norm(Vec2{ambient.x, ambient.y})) / (1 + Rotation::kLargestBias);
  if (!(most > 0))
    throw Error(Errc::usage, "field",
                "the coils cannot rotate a field in the plane of the sample within their current limits; use "
                "coils along two axes, as in rigs/thesis-four-coils.toml, and a larger limits.max_current");
  if (p.rotating && *p.rotating > most)
    throw Error(Errc::usage, "controller.rotating",
                fmt::format("{:.3g} mT is too large for the coils; it must be at most {:.3g} mT, which "
                            "leaves current for the bias and the ambient field; reduce it, or increase "
                            "limits.max_current and max_current of the coils",
                            *p.rotating * 1e3, most * 1e3));
  return p.rotating.value_or(std::min(preset, most));
}

/// The largest frequency at which cells stay locked, Hz; infinity if they follow at once.
double step_out(const SwarmMotion& m, double strength) {
  if (m.response != Response::turning) return std::numeric_limits<double>::infinity();
  return m.turning * strength / (2 * kPi);
}

/// The largest frequency, Hz, at which the change of every current from frame to frame is within the slew
/// rate.
double slewed(const ControlContext& c, double strength) {
  if (!c.max_slew) return std::numeric_limits<double>::infinity();
  const std::vector<double> x = allocate(*c.field, {}, {1, 0}), y = allocate(*c.field, {}, {0, 1});
  double amplitude = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    amplitude = std::max(amplitude, strength * norm(Vec2{x[k], y[k]}));
  const double change = *c.max_slew * c.frame_period;
  return change < 2 * amplitude ? std::asin(change / (2 * amplitude)) / (kPi * c.frame_period)
                                : std::numeric_limits<double>::infinity();
}

double locked_frequency(const RotationParams& p, const SwarmMotion& m, double strength, double period) {
  const double locked = step_out(m, strength), shown = 1 / (kFramesPerTurn * period);
  if (!(locked > 0))
    throw Error(Errc::usage, "controller.turning",
                "is 0: the cells do not turn in a field; specify the turning rate of the cells");
  if (!p.frequency) return std::min({kDefaultFrequency, kDefaultStepOut * locked, shown});
  const double most = kMostStepOut * locked, wanted = std::fabs(*p.frequency);
  if (wanted > most)
    throw Error(Errc::usage, "controller.frequency",
                fmt::format("{:g} Hz is too fast for the cells, which step out at {:.3g} Hz in {:.3g} mT; it "
                            "must be between -{:.3g} and {:.3g} Hz; reduce it, or increase "
                            "controller.rotating",
                            *p.frequency, locked, strength * 1e3, most, most));
  if (wanted > shown * (1 + 1e-9))
    throw Error(Errc::usage, "controller.frequency",
                fmt::format("{:g} Hz is too fast for {:g} frames/s, because the field is constant during a "
                            "frame; it must be between -{:.3g} and {:.3g} Hz, {:g} frames per turn; reduce "
                            "it, or increase the frame rate",
                            *p.frequency, 1 / period, shown, shown, kFramesPerTurn));
  return *p.frequency;
}

double checked_frequency(const RotationParams& p, const SwarmMotion& m, double strength,
                         const ControlContext& c) {
  const double frequency = locked_frequency(p, m, strength, c.frame_period), most = slewed(c, strength);
  if (std::fabs(frequency) <= most) return frequency;
  throw Error(
      Errc::usage, "controller.frequency",
      fmt::format("{:.3g} Hz in {:.3g} mT is too fast for the coils, whose currents change by at most "
                  "{:g} A/s; it must be between -{:.3g} and {:.3g} Hz; reduce it or "
                  "controller.rotating, or increase limits.max_slew",
                  frequency, strength * 1e3, *c.max_slew, most, most));
}

}  // namespace

Schema<RotationParams> RotationParams::schema() {
  return Schema<RotationParams>("rotation", "Rotating field")
      .add("rotating", &RotationParams::rotating,
           {.unit = "T",
            .min = 1e-7,
            .max = 0.1,
            .doc = "Magnitude of the rotating field; default: 1 mT (rotating_hold) or 0.3 mT (mixture), 5 "
                   "field units for cells whose drift is proportional to the field, or less if the coils "
                   "cannot make it",
            .title = "Rotating field"})
      .add("frequency", &RotationParams::frequency,
           {.unit = "Hz",
            .min = -1000,
            .max = 1000,
            .doc = "Rotation frequency, counterclockwise positive; default: 5 Hz, but at most half of the "
                   "frequency at which the cells step out, and an eighth of the frame rate"})
      .add("gain", &RotationParams::gain,
           {.min = 1e-3,
            .max = 1,
            .doc = "Loop gain; the proportional gain is gain / (delay + half a revolution)",
            .source = "0.45: theory F3",
            .title = "Loop gain"})
      .check([](const RotationParams& p) -> std::string {
        return p.frequency && *p.frequency == 0 ? "frequency is 0 Hz; a rotating field needs a positive or a "
                                                  "negative frequency, such as \"5 Hz\""
                                                : "";
      });
}

Rotation::Rotation(const RotationParams& p, double strength, const SwarmMotion& motion,
                   const ControlContext& c)
    : strength_(checked_strength(
          p, motion.response == Response::proportional ? 5 * c.scale.field_unit : strength, c)),
      rate_(2 * kPi * checked_frequency(p, motion, strength_, c)),
      period_(c.frame_period) {
  effective_ = strength_ * harmonic(std::fabs(rate_) * period_ / 2);
}

void Rotation::advance(double dt) {
  if (std::isfinite(dt)) phase_ = std::remainder(phase_ + std::remainder(rate_ * dt, 2 * kPi), 2 * kPi);
}

Vec2 Rotation::field() const {
  const auto turn = portable::sincos(float(phase_));
  return {strength_ * double(turn.cos), strength_ * double(turn.sin)};
}

Vec2 Rotation::direction(double age) const {
  const double back = std::clamp(rate_ * (age + period_ / 2), -kLargestPhase, kLargestPhase);
  const auto turn = portable::sincos(float(phase_ - back));
  return {double(turn.cos), double(turn.sin)};
}

CirclingSwarm::CirclingSwarm(const SwarmMotion& m, const Rotation& r, double gain, const ControlContext& c)
    : speed_(m.response == Response::proportional ? m.mobility * r.effective() : m.speed),
      efficiency_(m.response == Response::proportional ? 1 : 0.5),
      sine_(0),
      cosine_(1) {
  double turning_time = 0;
  if (m.response == Response::turning) {
    const double w = m.turning * r.effective();
    constexpr double kMostSine = 0.95;  // a second swarm that has stepped out
    sine_ = std::clamp(r.rate() / w, -kMostSine, kMostSine);
    cosine_ = std::sqrt(1 - sine_ * sine_);
    turning_time = 1 / (w * cosine_);
  }
  gain_ = gain / ((c.delay_frames + 0.5) * c.frame_period + turning_time + kPi / std::fabs(r.rate()));
}

Vec2 CirclingSwarm::centre(Vec2 position, double age, double sign, const Rotation& r) const {
  const Vec2 along = r.direction(age);
  const Vec2 heading{cosine_ * along.x + sine_ * along.y, cosine_ * along.y - sine_ * along.x};
  return position + (sign * speed_ / r.rate()) * Vec2{-heading.y, heading.x};
}

Vec2 CirclingSwarm::drift(Vec2 error) const {
  const Vec2 wanted = gain_ * error;
  const double size = norm(wanted), most = max_drift();
  return size > most ? (most / size) * wanted : wanted;
}

Vec2 CirclingSwarm::hold(Vec2 position, Vec2 target, double age, const Rotation& r) const {
  const Vec2 error = target - centre(position, age, 1, r);
  return r.field() + bias(std::isfinite(norm(error)) ? drift(error) : Vec2{}, r);
}

Vec2 CirclingSwarm::bias(Vec2 drift, const Rotation& r) const {
  if (!(mobility() > 0)) return {};
  const double per_drift = r.effective() / mobility();
  return per_drift * Vec2{cosine_ * drift.x + sine_ * drift.y, cosine_ * drift.y - sine_ * drift.x};
}

Vec2 CirclingSwarm::drift_by(Vec2 bias, const Rotation& r) const {
  const double by_bias = mobility() / r.effective();
  return by_bias * Vec2{cosine_ * bias.x - sine_ * bias.y, cosine_ * bias.y + sine_ * bias.x};
}

}  // namespace faba
