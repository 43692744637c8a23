#include "study/identify/episode.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faba {
namespace {

constexpr double kAnywhere = 0.01;  // share of the mean number of cells that is spread over the view: where
                                    // none is seen quantiles are then those of the view
constexpr double kFew = 0.02;       // share in view that is as good as none
constexpr const char* kDensityNumbers[] = {"cells in view", "10 % along", "median along", "90 % along",
                                           "width across"};
constexpr int kMoments = 6;  // of each segment
// How many cells a crowd is taken for depends on how each of them looks. At the true parameters simulations
// of experiments 0 and 1 of bench/recovery.py were counted 6 % above the videos, though as wide and as
// strong.
constexpr double kCount = 0.1;
// So much more or less of them is seen in a crowd at the edge of a drop, where light is lost to both.
constexpr double kMass = 0.05;

/// A distribution along one direction of the view, by bins of a pixel.
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
    const double place = std::clamp(dot(at, along_) - low_, 0.0, double(mass_.size() - 1));
    mass_[std::size_t(place)] += weight;
  }
  void add_everywhere(double weight) {
    for (double& m : mass_) m += weight / double(mass_.size());
  }
  /// Share p of the mass lies below it; as a share of the view's length.
  double quantile(double p) const {
    double sum = 0;
    for (const double m : mass_) sum += std::max(m, 0.0);
    double want = p * sum;
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      const double m = std::max(mass_[i], 0.0);
      if (want <= m) return (double(i) + (m > 0 ? want / m : 0)) / double(mass_.size());
      want -= m;
    }
    return 1;
  }

 private:
  Vec2 along_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
  std::vector<double> mass_;
};

/// At six moments of each segment how many cells are in view, where along the direction of the segment 10, 50
/// and 90 % of them are, and how wide they spread across it; and how many there are in all.
class DensityStatistics final : public EpisodeStatistics {
 public:
  DensityStatistics(const Episode& episode, const CellView& view);
  std::vector<double> of_frames(const std::vector<GrayF>& frames) const override;
  std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const override;
  void blur(std::vector<double>& numbers, StudyRandom& random) const override {
    for (std::size_t k = 0; k + 1 < numbers.size(); k += std::size(kDensityNumbers))
      numbers[k] += kMass * random.normal();
    numbers.back() += kCount * random.normal();
  }

 private:
  struct Mass {
    Vec2 at;
    double weight;
  };
  std::vector<double> summed(const std::vector<std::vector<Mass>>& seen, double cells) const;

  Episode episode_;
  CellView view_;
  std::vector<std::size_t> segment_at_;  ///< of each moment
};

DensityStatistics::DensityStatistics(const Episode& e, const CellView& view) : episode_(e), view_(view) {
  for (std::size_t d = 0; d < e.segments.size(); ++d)
    for (int i = 1; i <= kMoments; ++i) {
      const FieldSegment& segment = e.segments[d];
      times_s_.push_back(segment.t0_s + (segment.t1_s - segment.t0_s) * i / kMoments);
      segment_at_.push_back(d);
    }
  for (std::size_t k = 0; k < times_s_.size(); ++k)
    for (const char* what : kDensityNumbers) numbers_.push_back({what, segment_at_[k], times_s_[k]});
  numbers_.push_back({"number of cells", 0, times_s_.back()});
}

std::vector<double> DensityStatistics::of_frames(const std::vector<GrayF>& frames) const {
  std::vector<std::vector<Mass>> seen;
  double most = 0;
  for (const GrayF& frame : frames) {
    const Foreground foreground = view_.seen_in(frame);
    const GrayF& w = foreground.weights();
    std::vector<Mass>& one = seen.emplace_back();
    for (int r = 0; r < w.height; ++r)
      for (int c = 0; c < w.width; ++c)
        if (const float v = w.at(c, r); v != 0) one.push_back({{double(c), double(r)}, double(v)});
    most = std::max(most, foreground.moments().cells);
  }
  return summed(seen, most);
}

std::vector<double> DensityStatistics::of_positions(const std::vector<std::vector<Vec2>>& positions) const {
  std::vector<std::vector<Mass>> seen;
  double most = 0;
  for (const auto& frame : positions) {
    std::vector<Mass>& one = seen.emplace_back();
    for (const Vec2 at : frame) one.push_back({at, 1.0});
    most = std::max(most, double(one.size()));
  }
  return summed(seen, most);
}

std::vector<double> DensityStatistics::summed(const std::vector<std::vector<Mass>>& seen,
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
    a.add_everywhere(kAnywhere * mean);
    b.add_everywhere(kAnywhere * mean);
    out.push_back(mean > 0 ? std::log(kFew + mass[k] / mean) : std::numeric_limits<double>::quiet_NaN());
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
