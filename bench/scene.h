#pragma once
#include <string>

#include "app/run/simulation.h"

namespace faba::bench {

/// A measured case: `model` in a box with one cell per ten pixels; cells are clamped at the walls.
/// - `basic`, `adapted`: parameters as published. The commanded drift is (4, 3) field units and changes sign
/// with
///   every new draw of velocities, so that cells do not accumulate at a wall. For `adapted` the command
///   compensates the Earth's field.
/// - `dipole`: IT-1 cells in 0.5 mT along x, 5 ms per step, headings in equilibrium.
struct Scene {
  std::string model;
  std::size_t agents = 0;
  std::string order = "none";  ///< of exclusion: "none", "two-phase", "published"
  unsigned threads = 1;
  bool exclusive() const { return order != "none"; }
};

constexpr Vec2 kDrift{4, 3};                       ///< field units
constexpr double kFieldUnit = 23e-6;               ///< T
constexpr int kHold = 2;                           ///< iterations between draws and sign changes of the drift
constexpr int kCycle = 2 * kHold;                  ///< steps after which the command repeats
constexpr int kBasicNoise = 8, kAdaptedNoise = 9;  ///< px per iteration
constexpr double kField = 0.5e-3;                  ///< T
constexpr double kStep = 5e-3;                     ///< s, for the dipole; a rotation of up to 1/3 rad
constexpr double kMetresPerPixel = 1e-6;
constexpr int kSettling = 40;  ///< steps; thirteen relaxation times of the heading

/// Width and height in px of the box for a number of agents, in the ratio 4 to 3.
struct Size {
  int width, height;
};
Size box(std::size_t agents);

/// A simulation of a scene with a saved state.
class Swarm {
 public:
  Swarm(const Scene& scene, Pool& pool);
  const Scene& scene() const { return scene_; }
  World& world() { return simulation_->world(); }
  const World& world() const { return simulation_->world(); }
  /// Copies the headings, step and time of `other`, which has the same cells, to the saved state.
  void take_headings(const Swarm& other);
  void restore() { world().restore(saved_); }
  void advance(int steps);
  /// Heap memory of the simulation per agent, without the occupancy grid.
  double bytes_per_agent() const { return bytes_; }

 private:
  Scene scene_;
  double bytes_ = 0;
  std::unique_ptr<Simulation> simulation_;
  State saved_;
};

}  // namespace faba::bench
