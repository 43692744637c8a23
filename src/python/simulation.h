#pragma once
#include <memory>

#include "app/run/simulation.h"
#include "app/sinks/drawn_swarm.h"
#include "python/in_use.h"
#include "python/loop_values.h"
#include "python/scene.h"

namespace faba::python {

/// A simulation of a scenario for Python: it is stepped frame by frame or to its end, and records nothing.
class PySimulation {
 public:
  PySimulation(Scenario s, unsigned threads, std::shared_ptr<Raised> raised);

  /// One control cycle; `command`: currents in place of those of the controller. Throws Error(usage) after
  /// the last frame.
  std::shared_ptr<TickCopy> turn(const std::optional<Command>& command);
  /// To the frame `end`, at most that of the scenario. At the end of the scenario the coils are
  /// de-energised.
  void run(std::optional<std::uint64_t> end);

  const Scenario& scenario() const { return scenario_; }
  const Simulation& simulation() const { return *simulation_; }
  std::uint64_t frame() const { return simulation_->loop().next; }
  bool finished() const { return frame() >= scenario_.frames(); }
  /// The picture of the camera; throws Error(usage) if the scenario renders none.
  ImageRef picture();
  /// The schematic picture of the lab. Throws Error(usage) before the first cycle.
  RgbImage drawing();
  std::vector<std::uint8_t> save();
  void restore(const std::vector<std::uint8_t>& saved);

  Exclusive& exclusive() { return exclusive_; }
  Raised& raised() { return *raised_; }

 private:
  class Last;
  void finish();

  Scenario scenario_;
  std::shared_ptr<Raised> raised_;
  Pool pool_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Last> last_;
  std::unique_ptr<DrawnSwarm> drawn_;
  Exclusive exclusive_{"Simulation"};
};

void bind_simulation(pybind11::module_& m);

}  // namespace faba::python
