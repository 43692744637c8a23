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
    track_of_.emplace_back(key(p), track.number);
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

std::optional<std::uint64_t> LinkCheck::track_of(Key spot) const {
  const auto at = std::lower_bound(track_of_.begin(), track_of_.end(), std::pair{spot, std::uint64_t{0}});
  return at == track_of_.end() || at->first != spot ? std::nullopt : std::optional(at->second);
}

LinkCheck::Tested LinkCheck::tested(std::uint64_t track) const {
  const auto at = tested_.find(track);
  return at == tested_.end() ? Tested{} : at->second;
}

std::optional<double> LinkCheck::reproduced() {
  reduced_.finish();
  take_links();
  std::sort(track_of_.begin(), track_of_.end());
  std::size_t compared = 0, same = 0;
  for (const auto& [from, to] : links_) {
    const auto a = track_of(from), b = track_of(to);
    ++compared;
    const bool is_same = a && b && *a == *b;
    if (is_same) ++same;
    if (a) {
      tested_[*a].links += 1;
      tested_[*a].reproduced += is_same;
    }
    if (b && !is_same) tested_[*b].links += 1;
  }
  if (compared < kFewLinks) return {};
  return double(same) / double(compared);
}

}  // namespace faba
