#include "study/tracks/track_bins.h"

#include "study/stats/statistics.h"

#include <cmath>
#include <cstddef>

namespace faba {
namespace {

constexpr std::size_t kSpans = 512;
constexpr double kFewest = 5;  // smallest number of vectors for an order parameter

}  // namespace

TimeBins::TimeBins(double span_s) : span_s_(span_s), x_(kSpans), y_(kSpans), length_(kSpans), n_(kSpans) {}

void TimeBins::add(double t_s, double x, double y) {
  while (t_s / span_s_ >= double(kSpans)) fold();
  const auto i = std::size_t(std::max(0.0, t_s / span_s_));
  x_[i] += x;
  y_[i] += y;
  length_[i] += std::hypot(x, y);
  n_[i] += 1;
}

std::vector<TimeBins::Span> TimeBins::spans() const {
  std::size_t end = kSpans;
  while (end > 0 && n_[end - 1] == 0) --end;
  std::vector<Span> out;
  for (std::size_t i = 0; i < end; ++i) {
    Span s{(double(i) + 0.5) * span_s_, kNaN, kNaN, kNaN, n_[i]};
    if (n_[i] > 0) {
      s.x = x_[i] / n_[i];
      s.y = y_[i] / n_[i];
    }
    if (n_[i] >= kFewest && length_[i] > 0) s.order = std::hypot(x_[i], y_[i]) / length_[i];
    out.push_back(s);
  }
  return out;
}

void TimeBins::fold() {
  for (auto* v : {&x_, &y_, &length_, &n_})
    for (std::size_t i = 0; i < kSpans; ++i) (*v)[i] = 2 * i + 1 < kSpans ? (*v)[2 * i] + (*v)[2 * i + 1] : 0;
  span_s_ *= 2;
}

}  // namespace faba
