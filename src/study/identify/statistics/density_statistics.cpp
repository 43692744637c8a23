#include "study/identify/statistics/episode.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faba {
namespace {

constexpr double kUniform = 0.01;    // fraction of the mean signal that is added uniformly over the view, so
                                     // that quantiles are defined without cells
constexpr double kLogOffset = 0.02;  // added to the fraction in view before the logarithm
constexpr const char* kDensityNumbers[] = {"cells in view", "10 % along", "median along", "90 % along",
                                           "width across"};
constexpr int kTimesPerSegment = 6;
// Model error (sd) of the logarithm of the cell count: the count in a dense group depends on the appearance
// of single cells. At the true parameters, simulations of experiments 0 and 1 of bench/recovery.py had counts
// 6 % above those of the videos at equal width and strength.
constexpr double kCountError = 0.1;
// Model error (sd) of the logarithm of the signal in view, for dense groups at the dark edge of a drop.
constexpr double kSignalError = 0.05;

/// Distribution of the signal along one direction of the view, in bins of one pixel.
class LightProfile {
 public:
  LightProfile(Vec2 along, int width, int height) : along_(along) {
    for (const Vec2 corner :
         {Vec2{0, 0}, Vec2{double(width), 0}, Vec2{0, double(height)}, Vec2{double(width), double(height)}}) {
      const double p = dot(corner, along);
      low_ = std::min(low_, p);
      high_ = std::max(high_, p);
    }
    mass_.assign(std::size_t(std::ceil(high_ - low_)) + 1, 0.0);
  }
  void add(Vec2 at, double weight) {
    const double position = std::clamp(dot(at, along_) - low_, 0.0, double(mass_.size() - 1));
    mass_[std::size_t(position)] += weight;
  }
  void add_uniform(double weight) {
    for (double& m : mass_) m += weight / double(mass_.size());
  }
  /// Length of the view in this direction, px.
  double length() const { return double(mass_.size()); }
  /// Quantile p, as a fraction of the length of the view.
  double quantile(double p) const {
    double sum = 0;
    for (const double m : mass_) sum += std::max(m, 0.0);
    double remaining = p * sum;
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      const double m = std::max(mass_[i], 0.0);
      if (remaining <= m) return (double(i) + (m > 0 ? remaining / m : 0)) / double(mass_.size());
      remaining -= m;
    }
    return 1;
  }

 private:
  Vec2 along_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
  std::vector<double> mass_;
};

/// Statistics at six times of each segment: signal in view, 10, 50 and 90 % quantiles of the position along
/// the direction of the segment, and width across it. The last statistic is the number of cells.
class DensityStatistics final : public EpisodeStatistics {
 public:
  DensityStatistics(const Episode& episode, const CellView& view);
  std::vector<double> of_frames(const std::vector<GrayF>& frames) const override;
  std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const override;
  std::vector<double> of_drift(Vec2 velocity) const override;
  void blur(std::vector<double>& numbers, StudyRandom& random) const override {
    for (std::size_t k = 0; k + 1 < numbers.size(); k += std::size(kDensityNumbers))
      numbers[k] += kSignalError * random.normal();
    numbers.back() += kCountError * random.normal();
  }

 private:
  struct Mass {
    Vec2 at;
    double weight;
  };
  std::vector<double> statistics_of(const std::vector<std::vector<Mass>>& seen, double cells) const;

  Episode episode_;
  CellView view_;
  std::vector<std::size_t> segment_at_;  ///< of each time
};

DensityStatistics::DensityStatistics(const Episode& e, const CellView& view) : episode_(e), view_(view) {
  for (std::size_t d = 0; d < e.segments.size(); ++d)
    for (int i = 1; i <= kTimesPerSegment; ++i) {
      const FieldSegment& segment = e.segments[d];
      times_s_.push_back(segment.t0_s + (segment.t1_s - segment.t0_s) * i / kTimesPerSegment);
      segment_at_.push_back(d);
    }
  for (std::size_t k = 0; k < times_s_.size(); ++k)
    for (const char* what : kDensityNumbers) numbers_.push_back({what, segment_at_[k], times_s_[k]});
  numbers_.push_back({"number of cells", 0, times_s_.back()});
}

// Cells that enter and leave the view are neglected.
std::vector<double> DensityStatistics::of_drift(Vec2 velocity) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < times_s_.size(); ++k) {
    const Vec2 along = unit_vector(episode_.segments[segment_at_[k]].direction_deg);
    const double length = LightProfile(along, view_.width, view_.height).length(),
                 shift = dot(velocity, along) * times_s_[k] / length;
    out.insert(out.end(), {0, shift, shift, shift, 0});
  }
  out.push_back(0);
  return out;
}

std::vector<double> DensityStatistics::of_frames(const std::vector<GrayF>& frames) const {
  std::vector<std::vector<Mass>> seen;
  double most = 0;
  for (const GrayF& frame : frames) {
    const Foreground foreground = view_.foreground_in(frame);
    const GrayF& w = foreground.weights();
    std::vector<Mass>& one = seen.emplace_back();
    for (int r = 0; r < w.height; ++r)
      for (int c = 0; c < w.width; ++c)
        if (const float v = w.at(c, r); v != 0) one.push_back({{double(c), double(r)}, double(v)});
    most = std::max(most, foreground.moments().cells);
  }
  return statistics_of(seen, most);
}

std::vector<double> DensityStatistics::of_positions(const std::vector<std::vector<Vec2>>& positions) const {
  std::vector<std::vector<Mass>> seen;
  double most = 0;
  for (const auto& frame : positions) {
    std::vector<Mass>& one = seen.emplace_back();
    for (const Vec2 at : frame) one.push_back({at, 1.0});
    most = std::max(most, double(one.size()));
  }
  return statistics_of(seen, most);
}

std::vector<double> DensityStatistics::statistics_of(const std::vector<std::vector<Mass>>& seen,
                                                     double cells) const {
  std::vector<double> mass;
  double mean = 0;
  for (const auto& one : seen) {
    double sum = 0;
    for (const Mass& m : one) sum += m.weight;
    mass.push_back(std::max(0.0, sum));
    mean += mass.back() / double(seen.size());
  }
  std::vector<double> out;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Vec2 along = unit_vector(episode_.segments[segment_at_[k]].direction_deg),
               across{-along.y, along.x};
    LightProfile a(along, view_.width, view_.height), b(across, view_.width, view_.height);
    for (const Mass& m : seen[k]) {
      a.add(m.at, m.weight);
      b.add(m.at, m.weight);
    }
    a.add_uniform(kUniform * mean);
    b.add_uniform(kUniform * mean);
    out.push_back(mean > 0 ? std::log(kLogOffset + mass[k] / mean)
                           : std::numeric_limits<double>::quiet_NaN());
    for (const double p : {0.1, 0.5, 0.9}) out.push_back(a.quantile(p));
    out.push_back(b.quantile(0.9) - b.quantile(0.1));
  }
  out.push_back(std::log1p(cells));
  return out;
}

}  // namespace

std::unique_ptr<EpisodeStatistics> density_statistics(const Episode& episode, const CellView& view) {
  return std::make_unique<DensityStatistics>(episode, view);
}

}  // namespace faba
