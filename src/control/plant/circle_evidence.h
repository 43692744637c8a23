#pragma once
#include <array>
#include <span>

#include "core/archive.h"
#include "core/vec.h"

namespace faba {

/// Which of two groups circles as which of two swarms, from their positions in a rotating field. With the
/// right swarm, the centre of the circle that follows from a position drifts at a constant velocity; with the
/// wrong one it circles, too. Therefore the variance of the velocities of the centres over a turn is
/// smaller for the right assignment.
class CircleEvidence {
 public:
  using Centres = std::array<Vec2, 2>;  ///< of both groups, m

  /// Adds a frame: the centres if the groups are as assigned, and if they are exchanged. `angle`: of the
  /// turn of the field since the last frame, rad.
  void add(const Centres& assigned, const Centres& exchanged, double angle);
  /// A frame in which both groups are not seen: the next one has no previous one.
  void skip() { seen_ = false; }
  /// Whether the last turn is complete and contradicts the assignment; starts a new turn if it is complete.
  bool contradicts();
  void archive(Archive& a);

 private:
  struct Motion {
    std::array<Vec2, 2> last, sum;  ///< of the steps from frame to frame, m
    double squares = 0;             ///< of both groups, m^2
    void add(const Centres& now, bool step);
    double variance(int steps) const;
    void archive(Archive& a);
  };
  Motion assigned_, exchanged_;
  double angle_ = 0;  ///< rad, of the steps of this turn
  int steps_ = 0;
  bool seen_ = false;  ///< in the last frame
};

}  // namespace faba
