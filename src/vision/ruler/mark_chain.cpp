#include "vision/ruler/mark_chain.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/statistics.h"

namespace faba {
namespace {

/// Position with the strongest and purest component at the pitch: the centre of a mark.
double best_position(const MarkProfile& y, double pitch) {
  const double reach = 2.5 * pitch, wave = 2 * std::numbers::pi / pitch;
  const int n = int(y.flat.size());
  double best = -1, position = 0;
  double next = reach;
  while (next < n - reach) {
    const double middle = std::exchange(next, next + pitch / 2);
    std::complex<double> sum = 0;
    double power = 0;
    bool complete = true;
    for (int i = std::max(0, int(middle - reach)); i < std::min(n, int(middle + reach) + 1); ++i) {
      const double v = y.flat[std::size_t(i)], u = (i - middle) / reach;
      if (!std::isfinite(v)) complete = false;
      const double weight = std::max(0.0, 1 - u * u);
      sum += weight * v * std::polar(1.0, -wave * (i - middle));
      power += weight * v * v;
    }
    const double score = complete && power > 0 ? std::norm(sum) / std::sqrt(power) : -1;
    if (score <= best) continue;
    best = score;
    position = middle - std::arg(-sum) / wave;
  }
  return y.first_s + position;
}

/// Extends the chain from `start` in one direction (`step` is +1 or -1).
void extend_chain(const MarkProfile& y, double start, double pitch, const MarkShape& shape, int step,
                  MarkChain& chain) {
  double at = start, gap = pitch;
  int missing = 0;
  for (int index = step; missing <= 3; index += step) {
    at += step * gap;
    const MarkReading r = read_mark(y, at, pitch, shape);
    missing = r.found ? 0 : missing + 1;
    if (!r.found) continue;
    chain[index] = at + r.shift_px;
    at += 0.5 * r.shift_px;
    gap = std::clamp(gap + 0.1 * step * r.shift_px, 0.9 * pitch, 1.1 * pitch);
  }
}

/// Whether the picture extends by half a pitch to both sides.
bool inside(const MarkProfile& y, double at, double pitch) {
  const double reach = std::max(pitch / 2, 2.5) + 1;
  const int from = int(at - reach - y.first_s), to = int(at + reach - y.first_s) + 1;
  return from >= 0 && to < int(y.raw.size()) && std::isfinite(y.raw[std::size_t(from)]) &&
         std::isfinite(y.raw[std::size_t(to)]);
}

}  // namespace

double mean_gap(const MarkChain& chain) {
  double k = 0, s = 0, kk = 0, ks = 0;
  const double n = double(chain.size());
  for (const auto& [index, position] : chain) {
    k += index / n;
    s += position / n;
  }
  for (const auto& [index, position] : chain) {
    kk += (index - k) * (index - k);
    ks += (index - k) * (position - s);
  }
  return ks / kk;
}

MarkChain trace_marks(const MarkProfile& y, double pitch) {
  double start = best_position(y, pitch);
  std::vector<double> near;
  for (int k = -2; k <= 2; ++k) near.push_back(start + k * pitch);
  MarkChain chain;
  // First with the shape of the five marks around the best position, then with that of all detected marks,
  // centred on the mark: for bright marks the first position is half a pitch off.
  for (int round = 0; round < 3; ++round) {
    MarkShape shape({&y, 1}, {&near, 1}, pitch);
    if (round == 1) {
      start += shape.centre_px();
      for (double& position : near) position += shape.centre_px();
      shape = MarkShape({&y, 1}, {&near, 1}, pitch);
    }
    chain.clear();
    extend_chain(y, start, pitch, shape, 1, chain);
    extend_chain(y, start, pitch, shape, -1, chain);
    const MarkReading first = read_mark(y, start, pitch, shape);
    if (first.found) chain[0] = start + first.shift_px;
    if (int(chain.size()) < kMinMarks) return {};
    const double gap = mean_gap(chain);
    if (!(gap > 0.85 * pitch && gap < 1.15 * pitch)) return {};
    pitch = gap;
    near.clear();
    for (const auto& [index, position] : chain) near.push_back(position);
  }
  return chain;
}

void follow_marks(const RotatedPicture& rotated, const MarkChain& chain, double pitch_px,
                  const MarkShape& shape, double t, int step, int strip_height, StripReadings& out) {
  double offset = 0;
  const int max_missed = std::max(2, int(0.4 * pitch_px / strip_height));
  for (int missed = 0; missed <= max_missed; t += step * strip_height) {
    const std::vector<double> raw = rotated.profile(t, strip_height);
    if (raw.empty()) return;
    const MarkProfile y(rotated.first_s(), raw, pitch_px);
    std::vector<StripReading> readings;
    std::vector<double> shifts;
    int expected = 0;
    for (const auto& [index, position] : chain) {
      const double at = position + offset;
      if (!inside(y, at, pitch_px)) continue;
      ++expected;
      const MarkReading r = read_mark(y, at, pitch_px, shape);
      if (!r.found) continue;
      readings.push_back({index, at + r.shift_px, t});
      shifts.push_back(r.shift_px);
    }
    const bool detected = expected >= kMinMarks && 2 * int(readings.size()) > expected;
    missed = detected ? 0 : missed + 1;
    if (!detected) continue;
    offset += median_high(shifts);
    out.list.insert(out.list.end(), readings.begin(), readings.end());
    // Missing marks inside the row are counted as expected.
    out.expected += expected;
  }
}

}  // namespace faba
