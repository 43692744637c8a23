#include "rig/setup/coil_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

// Linear interpolation, with linear extrapolation beyond the ends; at least two points with increasing x.
double interpolate_volts(std::span<const Vec2> points, double x) {
  std::size_t i = 1;
  while (i + 1 < points.size() && x > points[i].x) ++i;
  const Vec2 a = points[i - 1], b = points[i];
  return a.y + (x - a.x) * (b.y - a.y) / (b.x - a.x);
}

std::vector<Vec2> swap_axes(const std::vector<Vec2>& table) {
  std::vector<Vec2> t;
  t.reserve(table.size());
  for (const Vec2 p : table) t.push_back({p.y, p.x});
  if (t.front().x > t.back().x) std::reverse(t.begin(), t.end());
  return t;
}

std::string wrong_with(const WiredCoil& c) {
  if (c.polarity != 1 && c.polarity != -1)
    return fmt::format("polarity = {}; it must be 1 or -1", c.polarity);
  if (c.gain == 0) return "gain must not be 0";
  if (c.sense_gain == 0) return "sense_gain must not be 0";
  if (c.least_volts >= c.most_volts) return "least_volts must be below most_volts";
  if (c.table.size() == 1) return "table needs at least two pairs of V and A";
  for (std::size_t i = 1; i < c.table.size(); ++i) {
    if (!(c.table[i].x > c.table[i - 1].x)) return "the voltages of table must increase";
    const bool up = c.table[1].y > c.table[0].y;
    if (c.table[i].y == c.table[i - 1].y || (c.table[i].y > c.table[i - 1].y) != up)
      return "the currents of table must be strictly monotonic";
  }
  const double zero = c.volts(0);
  if (zero < c.least_volts || zero > c.most_volts)
    return fmt::format("the voltage of zero current, {:g} V, is out of the output range {:g} to {:g} V", zero,
                       c.least_volts, c.most_volts);
  return "";
}

std::size_t number_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return std::size_t(at - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

constexpr std::size_t kNone = std::size_t(-1);

}  // namespace

Schema<WiredCoil> WiredCoil::schema() {
  return Schema<WiredCoil>("coil", "Wiring and calibration of one coil")
      .add("channel", &WiredCoil::channel,
           {.doc = "Output of the driver; coils with the same output are wired together"})
      .add("gain", &WiredCoil::gain,
           {.unit = "A/V", .min = -1e4, .max = 1e4, .doc = "Current per volt at the output"})
      .add("neutral", &WiredCoil::neutral,
           {.unit = "V", .min = -1e3, .max = 1e3, .doc = "Voltage at which no current flows"})
      .add("polarity", &WiredCoil::polarity,
           {.min = -1, .max = 1, .doc = "1, or -1 if the coil is wired in reverse"})
      .add("table", &WiredCoil::table,
           {.doc = "Measured pairs [V, A] with increasing voltage, instead of gain and neutral"})
      .add(
          "least_volts", &WiredCoil::least_volts,
          {.unit = "V", .min = -1e3, .max = 1e3, .doc = "Lowest voltage of the output", .source = "USB-6009"})
      .add("most_volts", &WiredCoil::most_volts,
           {.unit = "V",
            .min = -1e3,
            .max = 1e3,
            .doc = "Highest voltage of the output",
            .source = "USB-6009"})
      .add("max_current", &WiredCoil::max_current,
           {.unit = "A",
            .min = 1e-6,
            .max = 1e3,
            .doc = "Current limit; the guard trips above it",
            .source = "assumed"})
      .add("max_rms", &WiredCoil::max_rms,
           {.unit = "A",
            .min = 1e-6,
            .max = 1e3,
            .doc = "Maximum continuous root mean square current; the guard trips above it",
            .source = "assumed"})
      .add("sense", &WiredCoil::sense, {.doc = "Input of the driver that senses the current"})
      .add("sense_gain", &WiredCoil::sense_gain,
           {.unit = "A/V", .min = -1e4, .max = 1e4, .doc = "Current per volt at that input"})
      .add("sense_neutral", &WiredCoil::sense_neutral,
           {.unit = "V", .min = -1e3, .max = 1e3, .doc = "Voltage at that input when no current flows"})
      .check(wrong_with);
}

double WiredCoil::volts(double current) const {
  const double wanted = polarity * current;
  return table.empty() ? neutral + wanted / gain : interpolate_volts(swap_axes(table), wanted);
}

double WiredCoil::current(double volts) const {
  return polarity * (table.empty() ? gain * (volts - neutral) : interpolate_volts(table, volts));
}

double WiredCoil::reach() const {
  return std::min(std::fabs(current(least_volts)), std::fabs(current(most_volts)));
}

CoilWiring::CoilWiring(std::vector<WiredCoil> coils) : coils_(std::move(coils)) {
  for (const WiredCoil& c : coils_) {
    channel_of_.push_back(number_of(channels_, c.channel));
    sense_of_.push_back(c.sense.empty() ? kNone : number_of(senses_, c.sense));
  }
}

std::vector<double> CoilWiring::volts(std::span<const double> currents) const {
  std::vector<double> sum(channels_.size(), 0.0), sharing(channels_.size(), 0.0);
  for (std::size_t k = 0; k < coils_.size(); ++k) {
    const WiredCoil& c = coils_[k];
    sum[channel_of_[k]] += std::clamp(c.volts(currents[k]), c.least_volts, c.most_volts);
    sharing[channel_of_[k]] += 1;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= sharing[i];
  return sum;
}

std::vector<double> CoilWiring::neutral() const { return volts(std::vector<double>(coils_.size(), 0.0)); }

std::vector<double> CoilWiring::currents(std::span<const double> volts) const {
  std::vector<double> all;
  for (std::size_t k = 0; k < coils_.size(); ++k) all.push_back(coils_[k].current(volts[channel_of_[k]]));
  return all;
}

std::vector<double> CoilWiring::sensed(std::span<const double> volts) const {
  std::vector<double> all;
  for (std::size_t k = 0; k < coils_.size(); ++k)
    all.push_back(sense_of_[k] == kNone ? std::nan("") : coils_[k].sensed(volts[sense_of_[k]]));
  return all;
}

}  // namespace faba
