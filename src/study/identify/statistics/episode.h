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
  double direction_deg = 0;            ///< swimming direction, image frame: 0 right, 90 down
  std::optional<double> field_t = {};  ///< field strength, T; empty when it was not recorded
};

/// A part of an experiment that one simulation reproduces, starting from known cell positions. Times are
/// relative to its start.
struct Episode {
  std::string name;    ///< of the experiment, for reports
  double start_s = 0;  ///< start time in the video
  std::vector<FieldSegment> segments;
  std::vector<Vec2> positions_image;  ///< cell positions at the start, px
  double length_s() const { return segments.empty() ? 0 : segments.back().t1_s; }
};

/// Statistics of an episode.
enum class Measure {
  density,  ///< distribution of the swarm at six times of each segment, without detection of single cells
  tracks    ///< motion of single cells in short tracks, three times in each segment
};

/// Computes the statistics of an episode from frames of a video or of a simulation.
class EpisodeStatistics {
 public:
  virtual ~EpisodeStatistics() = default;

  /// Times of the frames that are needed, s, ascending.
  const std::vector<double>& times_s() const { return times_s_; }
  /// Description of one statistic.
  struct Number {
    std::string what;         ///< "median along"
    std::size_t segment = 0;  ///< index of the segment
    double t_s = 0;           ///< time; the end of the segment for statistics of an entire segment
  };
  const std::vector<Number>& numbers() const { return numbers_; }

  /// Statistics from one frame for each of times_s(), grey values 0 to 255. Can be NaN when no cells are
  /// visible in any frame.
  virtual std::vector<double> of_frames(const std::vector<GrayF>& frames) const = 0;
  /// Statistics from the positions of the cells in view at each of times_s(), px.
  virtual std::vector<double> of_positions(const std::vector<std::vector<Vec2>>& seen) const = 0;
  /// Change of the statistics, to first order, when all cells have an additional velocity, px/s.
  virtual std::vector<double> of_drift(Vec2 velocity) const = 0;
  /// Adds the model error of each statistic to the statistics of a simulation: rendered cells differ from
  /// real cells.
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
