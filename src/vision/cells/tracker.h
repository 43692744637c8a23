#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "vision/cells/detector.h"

namespace faba {

/// One detection of a track. Image frame, px, y down.
struct TrackPoint {
  std::uint64_t frame = 0;
  double t_s = 0;
  double x_px = 0, y_px = 0, mass = 0, snr = 0;
};

/// Track of one cell or bead in temporal order; frames without detection are missing.
struct Track {
  std::uint64_t number = 0;  ///< 1, 2, 3 ... in the order in which tracks were confirmed
  std::vector<TrackPoint> points;
  bool continues = false;  ///< true: a piece of a long track; the next piece has the same number
};

/// Motion model for the prediction of the next position.
enum class Motion {
  automatic,  ///< the model with the smaller mean squared prediction error so far
  nearest,    ///< last position: for diffusing particles
  velocity    ///< constant velocity, Kalman filter of position and velocity: for swimming cells
};

/// Parameters of Tracker.
struct TrackerOptions {
  double search_radius_px =
      0;  ///< maximum displacement between frames; 0: estimated by estimated_search_radius()
  Motion motion = Motion::automatic;
  int max_gap_frames = 2;  ///< maximum number of consecutive frames without detection
  int min_points = 3;      ///< minimum length; shorter tracks are discarded as noise
  int max_points = 4096;   ///< longer tracks are returned in pieces of this length, which limits the memory
};

/// Links spots to tracks, frame by frame: input spots, output finished tracks. The frame spacing may vary.
///
/// In each frame every live track predicts its position with an uncertainty. Pairs of track and spot inside
/// the gate are weighted by their likelihood ratio against "missed detection and new spot", and the
/// assignment with the maximum total weight is used (best_assignment). Unassigned tracks may then take a
/// remaining spot within reach of their last position; this handles reversals. Remaining spots start new
/// tracks; tracks without detection for more than `max_gap_frames` frames end. The velocity of a track with
/// one point is the median of all tracks.
class Tracker {
 public:
  explicit Tracker(TrackerOptions options = {});

  /// Processes the spots of the next frame. `frame` and `t_s` must increase, else Error(Errc::internal).
  void take(std::uint64_t frame, double t_s, const std::vector<Spot>& spots);
  /// Ends all tracks; take() must not be called afterwards.
  void finish();
  /// Tracks and pieces of long tracks finished since the last call.
  std::vector<Track> finished();

  /// Confirmed live tracks with the points not yet returned, for drawing. Empty during the first frames (up
  /// to 12), which are buffered to estimate reach and motion model.
  std::vector<const Track*> live() const;
  double search_radius_px() const { return options_.search_radius_px; }  ///< 0: not yet estimated
  /// Whether the displacement between frames is comparable to the distance between cells, so that the reach
  /// was limited: identities are then not reliable.
  bool crowded() const { return crowded_; }
  Motion motion() const { return motion_; }  ///< current model
  std::uint64_t confirmed_tracks() const { return confirmed_; }
  /// Number of tracks that ended with fewer than `min_points` points.
  std::uint64_t discarded_tracks() const { return dropped_; }

 private:
  struct Live {
    Track track;
    std::size_t points = 0;                        ///< including points already returned
    Vec2 at, velocity;                             ///< px, px/s
    double var_at = 0, cov = 0, var_velocity = 0;  ///< variances and covariance per axis
    double t_s = 0;
    int missed = 0;
  };
  struct BufferedFrame {
    std::uint64_t frame;
    double t_s;
    std::vector<Spot> spots;
  };
  struct Prediction {
    Vec2 at;
    double var = 0, gate = 0;
  };

  void start();
  void step(std::uint64_t frame, double t_s, const std::vector<Spot>& spots);
  Prediction predict(const Live& l, double t_s) const;
  void assign(double t_s, const std::vector<Spot>& spots, bool second, std::vector<int>& of_track,
              std::vector<bool>& taken) const;
  void update_track(Live& l, std::uint64_t frame, double t_s, const Spot& spot);
  void compare_models(const Live& l, double dt, Vec2 observed);
  void start_track(std::uint64_t frame, double t_s, const Spot& spot);
  void end_track(Live& l);
  void update_common_velocity();

  TrackerOptions options_;
  Motion motion_ = Motion::nearest;
  std::vector<Live> live_;
  std::vector<Track> finished_;
  std::vector<BufferedFrame> buffered_;
  bool started_ = false, crowded_ = false;
  double frame_s_ = 0, last_t_ = 0;
  std::uint64_t confirmed_ = 0, dropped_ = 0;
  Vec2 common_velocity_;     ///< px/s, median over the tracks
  double acceleration_ = 0;  ///< variance of velocity gained per s, px^2/s^3
  double scatter_ = 0;       ///< mean square displacement per axis, px^2 per frame
  double error_nearest_ = 0, error_velocity_ = 0, link_weight_ = 0;
};

/// Estimates the maximum displacement between frames: 1.25 times the distance within which 95 % of the spots
/// that have a successor find it. Nearest-neighbour distances to the next frame are counted and corrected for
/// random neighbours at the local density. At most three quarters of the mean spacing (then `cut` is set), at
/// least 2 px; 10 px (assumed) when no two consecutive frames have spots.
double estimated_search_radius(const std::vector<std::vector<Spot>>& frames, bool* cut = nullptr);

}  // namespace faba
