#include "study/tracks/link_check.h"

#include <algorithm>
#include <bit>

#include "core/random/splitmix64.h"

namespace faba {
namespace {

constexpr std::uint64_t kEvery = 4;    // every fourth frame is omitted
constexpr std::size_t kFewLinks = 30;  // the standard error of a fraction of 0.9 is then 0.055

}  // namespace

LinkCheck::Key LinkCheck::key(const TrackPoint& p) {
  return splitmix64(splitmix64(splitmix64(p.frame) ^ std::bit_cast<std::uint64_t>(p.x_px)) ^
                    std::bit_cast<std::uint64_t>(p.y_px));
}

void LinkCheck::take(std::uint64_t frame, double t_s, const std::vector<Spot>& spots) {
  if (over_) return;
  if (spots_ + spots.size() > kMostSpots && taken_ > 2 * kEvery) {
    over_ = true;
    return;
  }
  spots_ += spots.size();
  last_frame_ = frame;
  if (++taken_ % kEvery == 0) {
    omitted_.push_back(frame);
    return;
  }
  reduced_.take(frame, t_s, spots);
  take_links();
}

void LinkCheck::track(const Track& track) {
  for (const TrackPoint& p : track.points) {
    if (p.frame > last_frame_) break;
    track_of_.emplace(key(p), track.number);
  }
}

void LinkCheck::take_links() {
  for (const Track& t : reduced_.finished())
    for (std::size_t i = 0; i + 1 < t.points.size(); ++i) {
      const TrackPoint &p = t.points[i], &q = t.points[i + 1];
      const auto next = std::upper_bound(omitted_.begin(), omitted_.end(), p.frame);
      if (next != omitted_.end() && *next < q.frame) links_.emplace_back(key(p), key(q));
    }
}

LinkCheck::Tested LinkCheck::tested(std::uint64_t track) const {
  const auto at = tested_.find(track);
  return at == tested_.end() ? Tested{} : at->second;
}

std::optional<double> LinkCheck::reproduced() {
  reduced_.finish();
  take_links();
  std::size_t compared = 0, same = 0;
  for (const auto& [from, to] : links_) {
    const auto a = track_of_.find(from), b = track_of_.find(to);
    ++compared;
    const bool is_same = a != track_of_.end() && b != track_of_.end() && a->second == b->second;
    if (is_same) ++same;
    if (a != track_of_.end()) {
      tested_[a->second].links += 1;
      tested_[a->second].reproduced += is_same;
    }
    if (b != track_of_.end() && !is_same) tested_[b->second].links += 1;
  }
  if (compared < kFewLinks) return {};
  return double(same) / double(compared);
}

}  // namespace faba
