#pragma once
#include <pybind11/numpy.h>

#include <memory>
#include <vector>

#include "app/run/simulation.h"
#include "python/scene.h"
#include "python/simulation.h"

namespace faba::python {

/// What a policy sees in a control cycle: centroid, setpoint, velocity and standard deviation of the
/// estimate, the visible fraction of the cells and the previous currents. Lengths are in units of half the
/// height of the view, times in s, currents in units of their maximum; not finite values are 0.
struct PolicyInput {
  static constexpr std::size_t kFixed = 9;
  static std::size_t size(const ControlContext& c) { return kFixed + c.max_current.size(); }
  static void fill(float* to, const ControlContext& c, const Estimate& e, const Target& target,
                   const Command& last);
};

/// Currents for the normalised action of a policy: a field vector or currents, each number from -1 to 1.
struct PolicyOutput {
  bool currents = false;  ///< the numbers are currents in units of their maximum
  double strength = 5;    ///< field units of a field vector of length 1
  std::size_t size(const ControlContext& c) const { return currents ? c.max_current.size() : 2; }
  Command command(const ControlContext& c, Vec2 centroid, const double* action) const;
};

/// Many simulations that are stepped together, each by one thread, for reinforcement learning.
class Worlds {
 public:
  /// `noise_px`: standard deviation of the noise of the centroid that a policy sees, in x and y.
  Worlds(Document scene, std::size_t number, unsigned threads, PolicyOutput output, double noise_px);

  /// Replaces worlds by new ones; `sets`: changes of the scenario of each.
  void reset(const std::vector<std::size_t>& which, const std::vector<std::uint64_t>& seeds,
             const std::vector<std::vector<std::pair<std::string, Json>>>& sets);
  /// One control cycle of every world with an action of each, and the observation of the next.
  void step(const double* actions);

  struct World {
    std::unique_ptr<Pool> pool;
    std::unique_ptr<Scenario> scenario;
    std::unique_ptr<Simulation> simulation;
    CycleInput cycle;
    bool finished = false;     ///< all frames of the scenario are simulated
    std::vector<float> input;  ///< of the policy
    Vec2 centroid;             ///< true, m
    double radius = 0;         ///< true root-mean-square distance of the cells from it, m
  };
  const std::vector<World>& all() const { return worlds_; }
  std::size_t inputs() const { return PolicyInput::size(worlds_.front().simulation->control()); }
  std::size_t outputs() const { return output_.size(worlds_.front().simulation->control()); }
  const PolicyOutput& output() const { return output_; }
  Pool& pool() { return pool_; }

 private:
  void begin(World& w) const;
  void look(World& w) const;

  Document scene_;
  PolicyOutput output_;
  double noise_px_;
  Parts parts_;
  Pool pool_;
  std::vector<World> worlds_;
};

void bind_worlds(pybind11::module_& m);

}  // namespace faba::python
