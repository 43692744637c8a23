#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/vec.h"

namespace faba {

template <class T>
struct Image;
/// Picture of an observation; null if the rig reports positions only.
using ImageRef = std::shared_ptr<const Image<std::uint8_t>>;

/// One cell as reported by the rig. Position in m, world frame; float because a rig may report a million
/// cells.
struct Detection {
  float x = 0, y = 0;
  bool in_view = true;  ///< inside the camera view; only a simulation reports cells outside it
};

/// Observation by the rig. `t`: mid-exposure, s on the rig's clock; with a camera delay it lies in the past.
struct Observation {
  std::uint64_t frame = 0;
  double t = 0;
  double age = 0;          ///< s from mid-exposure until the rig delivers it
  bool coils_off = false;  ///< the coils were de-energised at some time since the last frame
  std::vector<Detection> seen;
  ImageRef image;
};

/// One of several swarms in view.
struct Group {
  Vec2 centroid;     ///< m, world
  double share = 0;  ///< fraction of what is in view; for a single group in a picture: of the maximum so far
  Mat2 cov;          ///< of the cell positions, m^2
};

/// Result of an estimator at time t. World frame, m.
struct Estimate {
  double t = 0;
  Vec2 centroid;
  Mat2 cov;            ///< of the cell positions, m^2
  Vec2 velocity;       ///< m/s
  double visible = 0;  ///< number of cells used; 0: none, `centroid` is the last known one
  std::vector<Group> groups;
  /// Whether `t`, `centroid` and `velocity` are those of the time at which the command of this cycle acts;
  /// otherwise those of the picture, which is older.
  bool predicted = false;
  /// Of the errors of both, m^2 and m^2/s^2; zero: not known. That of the position of a picture is the error
  /// of a sample: which cells are seen changes slowly, so that it is not smaller in the mean of several
  /// frames.
  Mat2 centroid_cov, velocity_cov;
};

/// Setpoint for the swarm. World frame, m.
struct Target {
  Vec2 position;          ///< NaN: no setpoint
  std::size_t index = 0;  ///< index of the setpoint on a route
  bool finished = false;  ///< the end of the route is reached
};

/// Output of a controller: one current per coil, A.
struct Command {
  std::vector<double> current;
};

}  // namespace faba
