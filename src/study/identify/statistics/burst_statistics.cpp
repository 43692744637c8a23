#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "study/identify/statistics/episode.h"
#include "study/stats/statistics.h"
#include "vision/cells/detector.h"
#include "vision/cells/tracker.h"

namespace faba {
namespace {

constexpr int kBursts = 3;            // per segment
constexpr int kFrames = 8;            // per burst
constexpr int kMinDetections = 6;     // of a cell in a burst
constexpr double kFrom = 0.2;         // fraction of a segment; the first burst starts after the U-turns
constexpr double kTo = 0.9;           // fraction of a segment; its end is not known to the frame
constexpr double kStepOffset = 0.01;  // px^2: added to squared steps before the logarithm
/// A statistic and its model error (sd): real cells vary more than simulated ones, and other particles are
/// tracked as well. Speeds in px per frame; the last two are logarithms. Assumed.
struct BurstNumber {
  const char* name;
  double blur;
};
constexpr BurstNumber kBurstNumbers[] = {{"10 % of speeds along", 0.1}, {"median speed along", 0.05},
                                         {"90 % of speeds along", 0.1}, {"spread of speeds across", 0.2},
                                         {"median step", 0.3},          {"cells followed", 0.3}};

/// Statistics of short tracks: velocities along and across the direction of the segment, and displacements
/// per frame, which diffusion makes larger than the mean velocity. Speeds in px per frame.
class BurstStatistics final : public EpisodeStatistics {
 public:
  BurstStatistics(const Episode& episode, const CellView& view) : episode_(episode), view_(view) {
    for (std::size_t d = 0; d < episode.segments.size(); ++d) {
      const FieldSegment& segment = episode.segments[d];
      const double length = segment.t1_s - segment.t0_s, burst = (kFrames - 1) * view.frame_s;
      const double first = kFrom * length, last = std::max(first, kTo * length - burst);
      for (int b = 0; b < kBursts; ++b)
        for (int k = 0; k < kFrames; ++k)
          times_s_.push_back(segment.t0_s + first + (last - first) * b / (kBursts - 1) + k * view.frame_s);
      for (const BurstNumber& what : kBurstNumbers) numbers_.push_back({what.name, d, segment.t1_s});
    }
  }

  std::vector<double> of_frames(const std::vector<GrayF>& frames) const override {
    const Detector detector = view_.detector();
    std::vector<std::vector<Spot>> spots;
    spots.reserve(frames.size());
    for (const GrayF& f : frames) spots.push_back(detector.find(f));
    return statistics_of(spots);
  }

  std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const override {
    std::vector<std::vector<Spot>> spots;
    for (const auto& frame : seen) {
      auto& one = spots.emplace_back();
      for (const Vec2 at : frame) one.push_back({.x_px = at.x, .y_px = at.y, .mass = 1, .snr = 10});
    }
    return statistics_of(spots);
  }

  // Squared steps change at second order only where cells swim across the drift; that is neglected.
  std::vector<double> of_drift(Vec2 velocity) const override {
    std::vector<double> out;
    for (const FieldSegment& segment : episode_.segments) {
      const double along = dot(velocity, unit_vector(segment.direction_deg)) * view_.frame_s;
      out.insert(out.end(), {along, along, along, 0, 0, 0});
    }
    return out;
  }

  void blur(std::vector<double>& numbers, StudyRandom& random) const override {
    for (std::size_t k = 0; k < numbers.size(); ++k)
      numbers[k] += kBurstNumbers[k % std::size(kBurstNumbers)].blur * random.normal();
  }

 private:
  std::vector<Track> tracks_of_burst(const std::vector<std::vector<Spot>>& spots, std::size_t first) const {
    TrackerOptions o;
    o.search_radius_px = view_.search_radius_px;
    o.min_points = kMinDetections;
    Tracker tracker(o);
    for (std::size_t k = 0; k < kFrames; ++k) tracker.take(k, double(k) * view_.frame_s, spots[first + k]);
    tracker.finish();
    return tracker.finished();
  }

  std::vector<double> statistics_of(const std::vector<std::vector<Spot>>& spots) const {
    std::vector<double> out;
    for (std::size_t d = 0; d < episode_.segments.size(); ++d) {
      const Vec2 direction = unit_vector(episode_.segments[d].direction_deg);
      std::vector<double> along, across, steps;
      for (std::size_t b = 0; b < kBursts; ++b)
        for (const Track& t : tracks_of_burst(spots, (d * kBursts + b) * kFrames)) {
          const TrackPoint &p = t.points.front(), &q = t.points.back();
          const Vec2 v = 1 / double(q.frame - p.frame) * Vec2{q.x_px - p.x_px, q.y_px - p.y_px};
          along.push_back(dot(v, direction));
          across.push_back(dot(v, {-direction.y, direction.x}));
          for (std::size_t k = 1; k < t.points.size(); ++k) {
            const Vec2 step{t.points[k].x_px - t.points[k - 1].x_px, t.points[k].y_px - t.points[k - 1].y_px};
            steps.push_back(dot(step, step));
          }
        }
      const double cells = double(along.size()) / kBursts;
      if (along.empty()) along = across = steps = {0};
      for (const double p : {0.1, 0.5, 0.9}) out.push_back(quantile(along, p));
      out.push_back(quantile(across, 0.9) - quantile(across, 0.1));
      out.push_back(std::log(kStepOffset + median(steps)));
      out.push_back(std::log1p(cells));
    }
    return out;
  }

  Episode episode_;
  CellView view_;
};

}  // namespace

std::unique_ptr<EpisodeStatistics> burst_statistics(const Episode& episode, const CellView& view) {
  return std::make_unique<BurstStatistics>(episode, view);
}

}  // namespace faba
