#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/threads/parallel.h"
#include "vision/cells/tracker.h"

namespace faba {

/// How the objects of a population move.
enum class PopulationMotion {
  moving,   ///< by more than the localisation error, in different directions or together with others
  still,    ///< not distinguishable from the localisation error
  drifting  ///< slowly and all in one direction, with the stage or the medium
};
const char* word_of(PopulationMotion motion);

/// Objects with similar speeds.
struct SpeedPopulation {
  double fraction = 0;           ///< of the windows: of the objects in view, over time
  double speed_px_s = 0;         ///< median of the windows
  std::array<double, 2> ci90{};  ///< 90 % interval of the median, px/s
  PopulationMotion motion = PopulationMotion::moving;
  std::uint64_t tracks = 0;  ///< with a window in this population
};

/// Separates objects into populations by their speeds. Each track is divided into windows, because objects
/// may stop and start. The speed in a window is the mean of its displacements, corrected for the
/// localisation error. A mixture of up to three normal distributions of the logarithm of the speed is fitted;
/// the number of components has the smallest Bayesian information criterion with as many observations as
/// there are tracks, or that of Akaike for fewer than eight. Components of less than 5 % of the windows (15 %
/// with three components), or nearer to each other than two standard deviations (Ashman's D), are not
/// separated. Memory: 20 000 windows for each of six lags.
class PopulationSurvey {
 public:
  /// `frame_s`: time between frames, s.
  explicit PopulationSurvey(double frame_s) : frame_s_(frame_s) {}
  void take(const Track& track);
  /// `interval`: frames between the positions of a displacement; `localisation_px`: standard deviation of a
  /// position per axis. Sorted by speed, the slowest first; empty without windows.
  std::vector<SpeedPopulation> populations(int interval, double localisation_px, Pool& pool) const;

 private:
  static constexpr std::array<int, 6> kLags{1, 2, 4, 8, 16, 32};
  /// A window of four times the lag.
  struct Window {
    float square = 0;      ///< squared mean displacement over the lag, px^2
    float vx = 0, vy = 0;  ///< mean velocity, px/s
    std::uint32_t track = 0;
  };
  struct Windows {
    std::vector<Window> kept;
    std::uint64_t seen = 0;
  };
  void take(const Track& track, std::size_t lag);

  double frame_s_;
  std::array<Windows, kLags.size()> windows_;
};

}  // namespace faba
