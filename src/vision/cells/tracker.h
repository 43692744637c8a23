#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "vision/cells/detector.h"

namespace faba {

/// One sighting of a track. Image frame, px, y down.
struct TrackPoint {
  std::uint64_t frame = 0;
  double t_s = 0;
  double x_px = 0, y_px = 0, mass = 0, snr = 0;
};

/// What one cell or bead did, in the order of time; frames in which it was not seen are missing.
struct Track {
  std::uint64_t number = 0;  ///< 1, 2, 3 ... in the order in which tracks became sure
  std::vector<TrackPoint> points;
  bool continues = false;  ///< a piece of a long track; the next piece has the same number
};

/// How a cell's next place is predicted.
enum class Motion {
  automatic,  ///< the one of the two whose mean squared error over the tracks so far is smaller
  nearest,    ///< where it is: for what diffuses
  velocity    ///< where its velocity takes it, by a Kalman filter of place and velocity: for what swims
};

/// Parameters of Tracker.
struct TrackerOptions {
  double reach_px =
      0;  ///< farthest displacement from one frame to the next; 0: found, see displacement_reach()
  Motion motion = Motion::automatic;
  int memory = 2;        ///< frames in a row that a cell may go unseen
  int least_points = 3;  ///< shorter tracks are noise and are not handed out
  int most_points =
      4096;  ///< longer tracks are handed out in pieces of this length, so that memory is bounded
};

/// Joins spots into tracks, frame by frame: spots in, finished tracks out. Times are those of the frames;
/// spacing may vary.
///
/// Each frame, every live track predicts its place with an uncertainty; pairs of track and spot inside the
/// gate are weighed by their likelihood against "the cell was missed and the spot is new", and the assignment
/// with the largest total is taken (best_assignment). Tracks that got nothing may then take a left-over spot
/// within reach of their last place, which is how reversals are followed. Spots left over begin tracks;
/// tracks unseen for more than `memory` frames end. Velocities are taken from the track itself, and for a
/// track of one point from the median of all tracks.
class Tracker {
 public:
  explicit Tracker(TrackerOptions options = {});

  /// The spots of the next frame. `frame` and `t_s` must increase, else Error(Errc::internal).
  void take(std::uint64_t frame, double t_s, const std::vector<Spot>& spots);
  /// Ends all tracks; nothing can be taken afterwards.
  void finish();
  /// Tracks that ended, and pieces of long ones, since the last call.
  std::vector<Track> finished();

  /// Tracks that are sure and live, with the points not yet handed out, for drawing. Empty while the first
  /// frames are looked at to find reach and motion (12 of them at most).
  std::vector<const Track*> live() const;
  double reach_px() const { return options_.reach_px; }  ///< 0 as long as it is not known
  /// Whether cells move as far from frame to frame as they are apart, so that reach had to be cut: then they
  /// cannot be told from each other.
  bool crowded() const { return crowded_; }
  Motion motion() const { return motion_; }  ///< in use now
  std::uint64_t sure_tracks() const { return numbered_; }
  /// Tracks given up before they had `least_points`.
  std::uint64_t uncertain_tracks() const { return dropped_; }

 private:
  struct Live {
    Track track;
    std::size_t points = 0;                        ///< also those handed out
    Vec2 at, velocity;                             ///< px, px/s
    double var_at = 0, cov = 0, var_velocity = 0;  ///< of each axis
    double t_s = 0;
    int missed = 0;
  };
  struct Waiting {
    std::uint64_t frame;
    double t_s;
    std::vector<Spot> spots;
  };
  struct Forecast {
    Vec2 at;
    double var = 0, gate = 0;
  };

  void begin();
  void step(std::uint64_t frame, double t_s, const std::vector<Spot>& spots);
  Forecast forecast(const Live& l, double t_s) const;
  void assign(double t_s, const std::vector<Spot>& spots, bool second, std::vector<int>& of_track,
              std::vector<bool>& taken) const;
  void follow(Live& l, std::uint64_t frame, double t_s, const Spot& spot);
  void weigh_motion(const Live& l, double dt, Vec2 seen);
  void give_birth(std::uint64_t frame, double t_s, const Spot& spot);
  void retire(Live& l);
  void learn_common_velocity();

  TrackerOptions options_;
  Motion motion_ = Motion::nearest;
  std::vector<Live> live_;
  std::vector<Track> finished_;
  std::vector<Waiting> waiting_;
  bool begun_ = false, crowded_ = false;
  double frame_s_ = 0, last_t_ = 0;
  std::uint64_t numbered_ = 0, dropped_ = 0;
  Vec2 common_velocity_;     ///< px/s, median over the tracks
  double acceleration_ = 0;  ///< variance of velocity gained per s, px^2/s^3
  double scatter_ = 0;       ///< variance of a displacement about none, of an axis, px^2 per frame
  double error_nearest_ = 0, error_velocity_ = 0, weighed_ = 0;
};

/// How far things move from one frame to the next: the distance within which 95 % of those that have a
/// successor find it, times 1.25. Nearest neighbours in the next frame are counted, and what chance gives at
/// the density around each spot is taken off. At most three quarters of the mean spacing; at least 2 px.
/// 10 px (assumed) when no two neighbouring frames have spots.
double displacement_reach(const std::vector<std::vector<Spot>>& frames, bool* cut = nullptr);

}  // namespace faba
