#include "rig/setup/amplifier.h"

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

std::string wrong_volts(const Amplifier::Params& p) {
  if (p.least_volts >= p.most_volts) return "least_volts must be below most_volts";
  if (p.gain == 0) return "gain must not be 0";
  if (p.reference < p.least_volts || p.reference > p.most_volts)
    return "reference must be between least_volts and most_volts";
  return "";
}

}  // namespace

Schema<Amplifier::Params> Amplifier::schema() {
  return Schema<Params>("amplifier", "Electronics of the simulated bench")
      .add("reference", &Params::reference,
           {.unit = "V",
            .min = -1e3,
            .max = 1e3,
            .doc = "Voltage at which no current flows",
            .source = "assumed"})
      .add("gain", &Params::gain,
           {.unit = "A/V",
            .min = -1e4,
            .max = 1e4,
            .doc = "Current per volt relative to the reference",
            .source = "assumed"})
      .add("saturation", &Params::saturation,
           {.unit = "A", .min = 1e-6, .max = 1e3, .doc = "Maximum absolute current", .source = "assumed"})
      .add("rise_time", &Params::rise_time,
           {.unit = "s",
            .min = 1e-6,
            .max = 10,
            .doc = "Time constant of a rising current, L/R",
            .source = "typical, 1 to 10 ms (C4)"})
      .add("fall_time", &Params::fall_time,
           {.unit = "s",
            .min = 1e-6,
            .max = 10,
            .doc = "Time constant of a falling current, through the free-wheel diodes",
            .source = "assumed"})
      .add("bits", &Params::bits,
           {.min = 1, .max = 24, .doc = "Resolution of the converter", .source = "USB-6009: 12"})
      .add("least_volts", &Params::least_volts,
           {.unit = "V",
            .min = -1e3,
            .max = 1e3,
            .doc = "Lowest voltage of the converter",
            .source = "USB-6009"})
      .add("most_volts", &Params::most_volts,
           {.unit = "V",
            .min = -1e3,
            .max = 1e3,
            .doc = "Highest voltage of the converter",
            .source = "USB-6009"})
      .add("enable_time", &Params::enable_time,
           {.unit = "s",
            .min = 1e-3,
            .max = 10,
            .doc = "Timeout of the enable line, after which the relay opens",
            .source = "assumed"})
      .add("enable_line", &Params::enable_line,
           {.doc =
                "false: no relay; the last voltages remain until new ones are set, as with a bare USB-6009"})
      .add("fault", &Params::fault,
           {.doc = "Simulated fault, to test the guard", .choices = {"none", "stuck", "open", "weak"}})
      .add("fault_after", &Params::fault_after,
           {.unit = "s", .min = 0, .max = 1e6, .doc = "Time from the first command to the fault"})
      .check(wrong_volts);
}

Amplifier::Amplifier(const Params& p, std::size_t coils) : p_(p), current_(coils, 0.0), target_(coils, 0.0) {}

double Amplifier::target(std::size_t k, double volts) const {
  const bool broken = started_ && t_ - first_command_ >= p_.fault_after;
  if (broken && p_.fault == Fault::stuck) return target_[k];
  if (broken && p_.fault == Fault::open) return 0;
  const double step = (p_.most_volts - p_.least_volts) / (std::exp2(p_.bits) - 1);
  const double put = std::clamp(volts, p_.least_volts, p_.most_volts);
  const double quantised = p_.least_volts + step * std::floor((put - p_.least_volts) / step + 0.5);
  const double i = std::clamp(p_.gain * (quantised - p_.reference), -p_.saturation, p_.saturation);
  return broken && p_.fault == Fault::weak ? 0.5 * i : i;
}

void Amplifier::take(std::span<const double> volts, bool enable, double t) {
  at(t);
  if (!started_) {
    first_command_ = t;
    started_ = true;
  }
  enabled_ = enable || !p_.enable_line;
  last_enable_ = t;
  for (std::size_t k = 0; k < target_.size() && k < volts.size(); ++k)
    if (!std::isnan(volts[k])) target_[k] = target(k, volts[k]);
}

void Amplifier::advance(double t) {
  for (std::size_t k = 0; k < current_.size(); ++k) {
    double left = t - t_;
    const double to = enabled_ ? target_[k] : 0;
    double& i = current_[k];
    if (i * to < 0) {  // first down to zero, with the fall time
      const double falling = p_.fall_time * std::log((i - to) / -to);
      if (falling >= left) {
        i = to + (i - to) * std::exp(-left / p_.fall_time);
        continue;
      }
      i = 0;
      left -= falling;
    }
    const double tau = std::fabs(to) >= std::fabs(i) ? p_.rise_time : p_.fall_time;
    i = to + (i - to) * std::exp(-left / tau);
  }
  t_ = t;
}

const std::vector<double>& Amplifier::at(double t) {
  if (!(t > t_)) return current_;
  if (p_.enable_line && enabled_ && last_enable_ + p_.enable_time < t) {
    advance(std::max(t_, last_enable_ + p_.enable_time));
    enabled_ = false;
  }
  advance(t);
  return current_;
}

std::vector<double> Amplifier::sensed() const {
  std::vector<double> volts;
  for (const double i : current_) volts.push_back(p_.reference + i / p_.gain);
  return volts;
}

}  // namespace faba
