#pragma once
#include <string>

#include "app/run/simulation.h"

namespace faba::bench {

/// What is timed: `model` in a box with one cell on every tenth pixel, clamped at the walls.
/// - `basic`, `adapted`: their parameters as published; the commanded drift is (4, 3) field units and changes
///   sign with every redraw, so that nothing piles up. For `adapted` the command makes up for the Earth's
///   field.
/// - `dipole`: IT-1 cells in 0.5 mT along x, 5 ms per step, headings settled.
struct Scene {
  std::string model;
  std::size_t agents = 0;
  std::string order = "none";  ///< of exclusion: "none", "two-phase", "published"
  unsigned threads = 1;
  bool exclusive() const { return order != "none"; }
};

constexpr Vec2 kDrift{4, 3};                       ///< field units
constexpr double kFieldUnit = 23e-6;               ///< T
constexpr int kHold = 2;                           ///< iterations; the drift changes sign as often
constexpr int kCycle = 2 * kHold;                  ///< steps after which the command repeats
constexpr int kBasicNoise = 8, kAdaptedNoise = 9;  ///< px per iteration
constexpr double kField = 0.5e-3;                  ///< T
constexpr double kStep = 5e-3;                     ///< s, of the dipole; a third of a radian of turning
constexpr double kMetresPerPixel = 1e-6;
constexpr int kSettling = 40;  ///< steps, thirteen relaxation times of the heading

/// Width and height in px of the box for so many agents, 4 to 3.
struct Size {
  int width, height;
};
Size box(std::size_t agents);

/// A scene brought to life, with a state to which it returns.
class Swarm {
 public:
  Swarm(const Scene& scene, Pool& pool);
  const Scene& scene() const { return scene_; }
  World& world() { return simulation_->world(); }
  const World& world() const { return simulation_->world(); }
  /// Settled headings of `other`, the same cells, become this swarm's; positions stay as they were placed.
  void take_headings(const Swarm& other);
  void restore() { world().restore(saved_); }
  void advance(int steps);
  /// Heap the simulation took, per agent, without the grid of exclusion.
  double bytes_per_agent() const { return bytes_; }

 private:
  Scene scene_;
  double bytes_ = 0;
  std::unique_ptr<Simulation> simulation_;
  State saved_;
};

}  // namespace faba::bench
