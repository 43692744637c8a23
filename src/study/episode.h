#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"
#include "vision/foreground.h"

namespace faba {

/// A time during which a field drives the cells in one direction.
struct Drive {
  double t0_s = 0, t1_s = 0;
  double direction_deg = 0;  ///< in which cells swim; image frame: 0 right, 90 down
};

/// A part of an experiment that is simulated in one go: it begins with cells at known places. Times count
/// from its beginning.
struct Episode {
  std::string name;     ///< of the experiment, for reports
  double begins_s = 0;  ///< in the video
  std::vector<Drive> drives;
  std::vector<Vec2> places_image;  ///< where cells are when it begins, px
  double length_s() const { return drives.empty() ? 0 : drives.back().t1_s; }
};

/// What is measured of an episode, of frames of a video and of simulated ones alike: at six moments of each
/// drive how many cells are in view, where along the direction of the drive 10, 50 and 90 % of them are, and
/// how wide they spread across it; and how many there are in all. All of it without finding cells one by one.
class EpisodeStatistics {
 public:
  static constexpr int kMoments = 6;  ///< of each drive

  EpisodeStatistics(const Episode& episode, int width, int height, const ForegroundOptions& cells);

  /// Moments whose frames are needed, s, in order: those that are measured, and others that the background is
  /// told from.
  const std::vector<double>& times_s() const { return times_s_; }
  /// The drive that each of them falls into.
  const std::vector<std::size_t>& drive_at() const { return drive_at_; }
  /// What each number is, in words: "drive 1, 2.5 s: median along".
  std::vector<std::string> names() const;
  /// Which drive each number belongs to.
  const std::vector<std::size_t>& drives() const { return drive_of_; }

  /// From one frame for each of times_s(), greys of 0 to 255. Not numbers when nothing is seen in any of
  /// them.
  std::vector<double> of_frames(const std::vector<GrayF>& frames) const;
  /// From the cells in view at each of times_s(), px.
  std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const;

 private:
  struct Mass {
    Vec2 at;
    double weight;
  };
  struct Look {
    std::size_t frame, drive;
  };
  std::vector<double> numbers(const std::vector<std::vector<Mass>>& seen, double cells) const;

  Episode episode_;
  int width_, height_;
  ForegroundOptions cells_;
  std::vector<double> times_s_;
  std::vector<std::size_t> drive_at_;
  std::vector<Look> looks_;
  std::vector<std::size_t> drive_of_;
};

}  // namespace faba
