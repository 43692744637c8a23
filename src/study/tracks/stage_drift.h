#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/cells/tracker.h"

namespace faba {

/// What the tracks show about a motion of the stage.
enum class StageFinding {
  undecided,  ///< no set of objects keeps its distances, so that a drift cannot be separated from swimming
  at_rest,    ///< such a set does not move
  drifting,   ///< such a set moves, and other objects move relative to it
  all_rigid   ///< all objects move and keep their distances: a drifting stage, or a swarm in formation
};
const char* word_of(StageFinding finding);

/// The motion of the stage between frames.
struct StageDrift {
  StageFinding finding = StageFinding::undecided;
  Vec2 drift_px_s;               ///< of the objects that keep their distances
  double drift_se_px_s = 0;      ///< standard error per axis
  double jitter_px = 0;          ///< standard deviation of the position per axis, about the drift
  std::uint64_t references = 0;  ///< number of tracks that keep their distances
  double error_px = 0;           ///< standard deviation of their positions per axis: the localisation error
  bool removed = false;          ///< speeds and mean-square displacements are relative to the stage

  std::uint64_t first_frame = 0;
  std::vector<Vec2> path_px;  ///< of the stage, for each frame from `first_frame`; empty when undecided
  /// A track relative to the stage.
  Track relative(const Track& track) const;
};

/// Finds the motion of the stage from the tracks of all objects. Objects that are fixed to the stage keep
/// their distances to each other within the localisation error, while swimming cells and diffusing particles
/// do not: a swarm that swims in one direction is not taken for a drift when there are five stationary
/// objects, and when its cells differ. Needs tracks with at least 16 detections. Memory: 2 million points.
class DriftSurvey {
 public:
  /// `frame_s`: time between frames, s.
  explicit DriftSurvey(double frame_s) : frame_s_(frame_s) {}
  void take(Track track);
  /// Undecided when there were more points than the memory holds.
  StageDrift result() const;
  /// The tracks; empty when there were more points than the memory holds.
  const std::vector<Track>& tracks() const { return tracks_; }

 private:
  double frame_s_;
  std::size_t points_ = 0;
  std::vector<Track> tracks_;
};

}  // namespace faba
