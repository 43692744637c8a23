#pragma once
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vision/cells/tracker.h"

namespace faba {

/// How reproducible the linking of spots to tracks is: the same spots are linked again without every fourth
/// frame, and the links across the omitted frames are compared with the tracks of all frames. A link is
/// reproduced when both of its spots belong to one of these tracks. Memory: the first 200 000 spots.
class LinkCheck {
 public:
  explicit LinkCheck(const TrackerOptions& options) : reduced_(options) {}

  /// The spots of the next frame, as for Tracker::take.
  void take(std::uint64_t frame, double t_s, const std::vector<Spot>& spots);
  /// A finished track, or part of a track, of all frames.
  void track(const Track& track);
  /// To be called after the last frame. Empty with fewer than 30 links.
  std::optional<double> reproduced();

  /// Links across an omitted frame with an end in one track, and those of them that were reproduced.
  struct Tested {
    std::uint64_t links = 0, reproduced = 0;
  };
  /// Of the track with this number; to be called after reproduced().
  Tested tested(std::uint64_t track) const;
  /// The last frame that was compared.
  std::uint64_t last_frame() const { return last_frame_; }

 private:
  static constexpr std::size_t kMostSpots = 200000;
  using Key = std::uint64_t;
  static Key key(const TrackPoint& p);
  void take_links();
  std::optional<std::uint64_t> track_of(Key spot) const;

  Tracker reduced_;
  bool over_ = false;
  std::uint64_t taken_ = 0;             ///< frames
  std::uint64_t last_frame_ = 0;        ///< of the frames that were taken
  std::vector<std::uint64_t> omitted_;  ///< frame numbers, ascending
  std::size_t spots_ = 0;
  /// Spots with the number of their track of all frames, sorted by reproduced().
  std::vector<std::pair<Key, std::uint64_t>> track_of_;
  std::unordered_map<std::uint64_t, Tested> tested_;
  std::vector<std::pair<Key, Key>> links_;  ///< across omitted frames
};

}  // namespace faba
