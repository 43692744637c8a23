#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "study/tracks/link_check.h"
#include "vision/cells/tracker.h"

namespace faba {

/// How well a track is supported by the frames.
struct TrackScore {
  std::uint64_t number = 0;
  std::uint64_t first_frame = 0, last_frame = 0, points = 0;
  double path_px = 0, distance_px = 0;  ///< along the track, and from its begin to its end
  double duration_s = 0;
  std::uint64_t links_tested = 0, links_reproduced = 0;  ///< see LinkCheck
  /// Fraction of the frames with a detection, times the expected fraction of correct links: (reproduced + 1)
  /// / (tested + 2), Laplace's rule of succession. Short tracks have few tested links and values near a half.
  /// Empty after the memory of LinkCheck is full.
  std::optional<double> score;
};

/// The scores of all tracks in one figure.
struct ScoreSummary {
  std::optional<double> mean;         ///< weighted by the number of points; empty without scored tracks
  std::array<double, 3> quantiles{};  ///< 10, 50, 90 % of the scored tracks
};
ScoreSummary summary_of(const std::vector<TrackScore>& scores);

/// Collects the tracks. Memory: about 100 bytes for each.
class TrackScores {
 public:
  void take(const Track& track);
  /// To be called after the last track, and after links.reproduced().
  std::vector<TrackScore> scores(const LinkCheck& links) const;

 private:
  struct Entry {
    TrackScore score;
    TrackPoint first, last;
  };
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, std::size_t> entry_of_;
};

}  // namespace faba
