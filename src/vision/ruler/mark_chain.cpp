#include "vision/ruler/mark_chain.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/statistics.h"

namespace faba {
namespace {

/// The place where the profile swings most strongly and purely at the pitch: the middle of a mark.
double best_place(const MarkProfile& y, double pitch) {
  const double reach = 2.5 * pitch, wave = 2 * std::numbers::pi / pitch;
  const int n = int(y.flat.size());
  double best = -1, place = 0;
  double next = reach;
  while (next < n - reach) {
    const double middle = std::exchange(next, next + pitch / 2);
    std::complex<double> sum = 0;
    double power = 0;
    bool whole = true;
    for (int i = std::max(0, int(middle - reach)); i < std::min(n, int(middle + reach) + 1); ++i) {
      const double v = y.flat[std::size_t(i)], u = (i - middle) / reach;
      if (!std::isfinite(v)) whole = false;
      const double weight = std::max(0.0, 1 - u * u);
      sum += weight * v * std::polar(1.0, -wave * (i - middle));
      power += weight * v * v;
    }
    const double worth = whole && power > 0 ? std::norm(sum) / std::sqrt(power) : -1;
    if (worth <= best) continue;
    best = worth;
    place = middle - std::arg(-sum) / wave;
  }
  return y.first_s + place;
}

/// Walks from `start` to one side (`step` is +1 or -1), adding to the chain.
void walk(const MarkProfile& y, double start, double pitch, const MarkShape& shape, int step,
          MarkChain& chain) {
  double at = start, gap = pitch;
  int missing = 0;
  for (int index = step; missing <= 3; index += step) {
    at += step * gap;
    const MarkReading r = read_mark(y, at, pitch, shape);
    missing = r.there ? 0 : missing + 1;
    if (!r.there) continue;
    chain[index] = at + r.shift_px;
    at += 0.5 * r.shift_px;
    gap = std::clamp(gap + 0.1 * step * r.shift_px, 0.9 * pitch, 1.1 * pitch);
  }
}

/// Whether the picture goes on for half a pitch to both sides.
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
  for (const auto& [index, place] : chain) {
    k += index / n;
    s += place / n;
  }
  for (const auto& [index, place] : chain) {
    kk += (index - k) * (index - k);
    ks += (index - k) * (place - s);
  }
  return ks / kk;
}

MarkChain walk_marks(const MarkProfile& y, double pitch) {
  double start = best_place(y, pitch);
  std::vector<double> near;
  for (int k = -2; k <= 2; ++k) near.push_back(start + k * pitch);
  MarkChain chain;
  // First with the look of the five marks about the best place, then with that of all that were found, from
  // the middle of a mark: a bright one is half a pitch off at first.
  for (int round = 0; round < 3; ++round) {
    MarkShape shape({&y, 1}, {&near, 1}, pitch);
    if (round == 1) {
      start += shape.centre_px();
      for (double& place : near) place += shape.centre_px();
      shape = MarkShape({&y, 1}, {&near, 1}, pitch);
    }
    chain.clear();
    walk(y, start, pitch, shape, 1, chain);
    walk(y, start, pitch, shape, -1, chain);
    const MarkReading first = read_mark(y, start, pitch, shape);
    if (first.there) chain[0] = start + first.shift_px;
    if (int(chain.size()) < kLeastMarks) return {};
    const double gap = mean_gap(chain);
    if (!(gap > 0.85 * pitch && gap < 1.15 * pitch)) return {};
    pitch = gap;
    near.clear();
    for (const auto& [index, place] : chain) near.push_back(place);
  }
  return chain;
}

void follow_marks(const TurnedPicture& turned, const MarkChain& chain, double pitch_px,
                  const MarkShape& shape, double t, int step, int strip_height, StripReadings& out) {
  double offset = 0;
  const int patience = std::max(2, int(0.4 * pitch_px / strip_height));
  for (int missed = 0; missed <= patience; t += step * strip_height) {
    const std::vector<double> raw = turned.profile(t, strip_height);
    if (raw.empty()) return;
    const MarkProfile y(turned.first_s(), raw, pitch_px);
    std::vector<StripReading> seen;
    std::vector<double> shifts;
    int possible = 0;
    for (const auto& [index, place] : chain) {
      const double at = place + offset;
      if (!inside(y, at, pitch_px)) continue;
      ++possible;
      const MarkReading r = read_mark(y, at, pitch_px, shape);
      if (!r.there) continue;
      seen.push_back({index, at + r.shift_px, t});
      shifts.push_back(r.shift_px);
    }
    const bool good = possible >= kLeastMarks && 2 * int(seen.size()) > possible;
    missed = good ? 0 : missed + 1;
    if (!good) continue;
    offset += median_high(shifts);
    out.list.insert(out.list.end(), seen.begin(), seen.end());
    // Marks that the row itself went across count as missing.
    out.possible += possible;
  }
}

}  // namespace faba
