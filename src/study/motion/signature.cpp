#include "study/motion/signature.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "core/units.h"
#include "vision/image/kernels/any_above.h"

namespace faba {
namespace {

constexpr double kSectorDeg = 360.0 / DirectionSums::kSectors;
constexpr int kInCone = 90 * DirectionSums::kSectors / 360;
constexpr std::uint64_t kSamples = 48;
constexpr std::size_t kAtOnce = 128;  // px; in most there is no motion

int wrapped(int sector) {
  return ((sector % DirectionSums::kSectors) + DirectionSums::kSectors) % DirectionSums::kSectors;
}

}  // namespace

void Signature::add(const FlowPair& pair, int px_side) {
  DirectionSums sums;
  const auto least = float(threshold_px_ * threshold_px_);
  // Rotated so that sector 0 starts at 0 degrees.
  const auto c = float(std::cos(zero_deg_ * kDegree)), s = float(std::sin(zero_deg_ * kDegree));
  const auto per_radian = float(DirectionSums::kSectors / (360 * kDegree));
  const auto& [us, vs] = pair.flow;
  for (std::size_t first = 0; first < us.px.size(); first += kAtOnce) {
    const std::size_t end = std::min(first + kAtOnce, us.px.size());
    if (!any_longer(&us.px[first], &vs.px[first], least, int(end - first))) continue;
    for (std::size_t i = first; i < end; ++i) {
      const float u = us.px[i], v = vs.px[i];
      if (!(u * u + v * v > least)) continue;
      const float turn = std::atan2(v * c - u * s, u * c + v * s) * per_radian;
      const auto sector = std::size_t(wrapped(int(std::floor(turn))));
      sums.amount[sector] += std::fabs(u) + std::fabs(v);
      sums.u[sector] += u;
      sums.v[sector] += v;
    }
  }
  const auto area = float(px_side * px_side);
  for (auto* list : {&sums.amount, &sums.u, &sums.v})
    for (float& x : *list) x *= area;
  t0_s_.push_back(pair.t0_s);
  t1_s_.push_back(pair.t1_s);
  sums_.push_back(sums);
}

bool Signature::still() const {
  for (std::size_t k = 0; k < size(); ++k)
    if (speed(k) > 0) return false;
  return true;
}

double Signature::nearest_deg(double deg) const {
  return std::fmod(zero_deg_ + kSectorDeg * std::round((deg - zero_deg_) / kSectorDeg) + 720, 360);
}

template <class Take>
void Signature::each_in_cone(double deg, Take&& take) const {
  const int first = int(std::lround((deg - zero_deg_) / kSectorDeg)) - kInCone / 2;
  for (int i = 0; i < kInCone; ++i) take(std::size_t(wrapped(first + i)));
}

double Signature::amount(std::size_t k, double deg) const {
  double sum = 0;
  each_in_cone(deg, [&](std::size_t i) { sum += double(sums_[k].amount[i]); });
  return sum;
}

double Signature::along(std::size_t k, double deg) const {
  const double c = std::cos(deg * kDegree), s = std::sin(deg * kDegree);
  double sum = 0;
  for (const double way : {deg, deg + 180})
    each_in_cone(way, [&](std::size_t i) { sum += double(sums_[k].u[i]) * c + double(sums_[k].v[i]) * s; });
  return sum;
}

Vec2 Signature::sum(std::size_t k) const {
  Vec2 w{0, 0};
  for (std::size_t i = 0; i < DirectionSums::kSectors; ++i) {
    w.x += double(sums_[k].u[i]);
    w.y += double(sums_[k].v[i]);
  }
  return w;
}

double Signature::speed(std::size_t k) const {
  double sum = 0;
  for (std::size_t i = 0; i < DirectionSums::kSectors; ++i)
    sum += std::hypot(double(sums_[k].u[i]), double(sums_[k].v[i]));
  return sum;
}

NoiseLevel noise_level(const std::filesystem::path& video, const FlowSourceOptions& options,
                       const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  FlowSourceOptions sampled = options;
  sampled.samples = kSamples;
  FlowSource source(video, sampled);
  FlowPair pair;
  std::vector<std::pair<double, double>> samples;  // mean speed, threshold
  std::vector<float> speeds;
  std::uint64_t done = 0;
  while (source.next(pair)) {
    speeds.resize(pair.flow.u.px.size());
    double sum = 0;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      speeds[i] = std::hypot(pair.flow.u.px[i], pair.flow.v.px[i]);
      sum += double(speeds[i]);
    }
    samples.emplace_back(sum / double(speeds.size()), double(quantile_low(speeds, 0.99)));
    progress(++done * source.every(), source.pairs());
  }
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const std::size_t quiet = std::max<std::size_t>(1, samples.size() / 10);
  std::vector<double> thresholds;
  for (std::size_t i = 0; i < quiet; ++i) thresholds.push_back(samples[i].second);
  const double busiest = samples[samples.size() - 1 - samples.size() / 20].first;
  return {median_high(thresholds), samples[quiet / 2].first < 0.5 * busiest};
}

}  // namespace faba
