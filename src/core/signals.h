#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/vec.h"

namespace faba {

template <class T>
struct Image;
/// A picture that goes with an observation; null when the rig reports positions only.
using ImageRef = std::shared_ptr<const Image<std::uint8_t>>;

/// One cell as the rig reports it. Position in m, world frame; float because a rig may report a million of
/// them.
struct Detection {
  float x = 0, y = 0;
  bool in_view = true;  ///< inside the camera's rectangle; only a simulation knows of cells outside
};

/// What the rig saw. `t`: mid-exposure, s on the rig's clock; with a camera delay it lies before the present.
struct Observation {
  std::uint64_t frame = 0;
  double t = 0;
  double age = 0;  ///< s from mid-exposure to the moment the rig hands it out
  bool coils_off =
      false;  ///< the coils had no current for a while since the last frame, whatever was commanded
  std::vector<Detection> seen;
  ImageRef image;
};

/// One of several swarms in view.
struct Group {
  Vec2 centroid;  ///< m, world
  double share =
      0;     ///< of what is in view; for a single group of a picture, of the most that ever was in view
  Mat2 cov;  ///< of the positions of its cells, m^2
};

/// What the estimator believes at time t. World frame, m.
struct Estimate {
  double t = 0;
  Vec2 centroid;
  Mat2 cov;            ///< of the cells' positions, m^2
  Vec2 velocity;       ///< m/s
  double visible = 0;  ///< cells the estimate rests on; 0: none, centroid is the last one known
  std::vector<Group> groups;
};

/// Where the swarm should be. World frame, m.
struct Target {
  Vec2 position;          ///< not a number: nowhere in particular
  std::size_t index = 0;  ///< of the setpoint on a route
  bool finished = false;  ///< the route has been walked to its end
};

/// What the controller asks for: one current per coil, A.
struct Command {
  std::vector<double> current;
};

}  // namespace faba
