#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/vec.h"
#include "study/stats/study_random.h"
#include "study/tracks/cell_view.h"

namespace faba {

/// A time interval in which the direction of the field is constant and cells swim along it.
struct FieldSegment {
  double t0_s = 0, t1_s = 0;
  double direction_deg = 0;            ///< in which cells swim; image frame: 0 right, 90 down
  std::optional<double> field_t = {};  ///< strength of the field, T, where it was recorded
};

/// A part of an experiment that is simulated in one go: it begins with cells at known places. Times count
/// from its beginning.
struct Episode {
  std::string name;     ///< of the experiment, for reports
  double begins_s = 0;  ///< in the video
  std::vector<FieldSegment> segments;
  std::vector<Vec2> places_image;  ///< where cells are when it begins, px
  double length_s() const { return segments.empty() ? 0 : segments.back().t1_s; }
};

/// How an episode is put into numbers.
enum class Measure {
  density,  ///< where the swarm is at six moments of each segment, without finding cells one by one
  tracks    ///< how cells move that are followed for a moment, three times in each segment
};

/// What is measured of an episode, of frames of a video and of simulated ones alike.
class EpisodeStatistics {
 public:
  virtual ~EpisodeStatistics() = default;

  /// Moments whose frames are needed, s, in order.
  const std::vector<double>& times_s() const { return times_s_; }
  /// What one of the numbers is.
  struct Number {
    std::string what;         ///< "median along"
    std::size_t segment = 0;  ///< to which it belongs
    double t_s = 0;           ///< when it is measured; the end of the segment for what is of all of it
  };
  const std::vector<Number>& numbers() const { return numbers_; }

  /// From one frame for each of times_s(), greys of 0 to 255. Not numbers when nothing is seen in any of
  /// them.
  virtual std::vector<double> of_frames(const std::vector<GrayF>& frames) const = 0;
  /// From the cells in view at each of times_s(), px.
  virtual std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const = 0;
  /// Makes numbers of a simulation as uncertain as the same measure of a video is, where rendered cells are
  /// not the real ones.
  virtual void blur(std::vector<double>& numbers, StudyRandom& random) const {
    (void)numbers;
    (void)random;
  }

 protected:
  std::vector<double> times_s_;
  std::vector<Number> numbers_;
};

std::unique_ptr<EpisodeStatistics> make_statistics(Measure measure, const Episode& episode,
                                                   const CellView& view);
std::unique_ptr<EpisodeStatistics> density_statistics(const Episode& episode, const CellView& view);
std::unique_ptr<EpisodeStatistics> burst_statistics(const Episode& episode, const CellView& view);

}  // namespace faba
