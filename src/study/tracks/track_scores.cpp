#include "study/tracks/track_scores.h"

#include <cmath>

#include "core/statistics.h"

namespace faba {
namespace {

double point_distance(const TrackPoint& a, const TrackPoint& b) {
  return std::hypot(b.x_px - a.x_px, b.y_px - a.y_px);
}

}  // namespace

ScoreSummary summary_of(const std::vector<TrackScore>& scores) {
  ScoreSummary out;
  std::vector<double> values;
  double sum = 0, points = 0;
  for (const TrackScore& s : scores) {
    if (!s.score) continue;
    values.push_back(*s.score);
    sum += *s.score * double(s.points);
    points += double(s.points);
  }
  if (values.empty()) return out;
  out.mean = sum / points;
  out.quantiles = {quantile(values, 0.1), median(values), quantile(values, 0.9)};
  return out;
}

void TrackScores::take(const Track& track) {
  if (track.points.empty()) return;
  const auto [at, is_new] = entry_of_.emplace(track.number, entries_.size());
  if (is_new) {
    Entry e;
    e.score.number = track.number;
    e.score.first_frame = track.points.front().frame;
    e.first = e.last = track.points.front();
    entries_.push_back(e);
  }
  Entry& e = entries_[at->second];
  for (const TrackPoint& p : track.points) {
    e.score.path_px += point_distance(e.last, p);
    e.last = p;
  }
  e.score.points += track.points.size();
  e.score.last_frame = e.last.frame;
  e.score.duration_s = e.last.t_s - e.first.t_s;
  e.score.distance_px = point_distance(e.first, e.last);
}

std::vector<TrackScore> TrackScores::scores(const LinkCheck& links) const {
  std::vector<TrackScore> out;
  out.reserve(entries_.size());
  for (const Entry& e : entries_) {
    TrackScore s = e.score;
    const LinkCheck::Tested tested = links.tested(s.number);
    s.links_tested = tested.links;
    s.links_reproduced = tested.reproduced;
    if (s.first_frame <= links.last_frame())
      s.score = double(s.points) / double(s.last_frame - s.first_frame + 1) * double(tested.reproduced + 1) /
                double(tested.links + 2);
    out.push_back(s);
  }
  return out;
}

}  // namespace faba
