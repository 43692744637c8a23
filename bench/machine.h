#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/threads/parallel.h"

namespace faba::bench {

/// Lower limits of the time of a step on this machine: random numbers, elementary functions and memory
/// traffic, each in a separate loop that is vectorised in the same way as the models. One unit is the work
/// for one agent.
/// - `philox`: one block, four random words
/// - `sincos`, `log`: one value, from and to the L1 cache
/// - `traffic`: positions and headings are read and written, one constant is read, 36 bytes
/// - `triad`: a = b + s c, 12 bytes
class Machine {
 public:
  Machine(std::size_t agents, Pool& pool);
  ~Machine();
  static const std::vector<std::string>& names();
  /// Runs the loop `name` `times` times over all agents.
  void run(const std::string& name, int times);
  /// Work of the two Box-Muller pairs of one agent-step: 1 philox + 2 sincos + 2 log + traffic.
  static constexpr int kSinCos = 2, kLog = 2;

 private:
  struct Memory;
  std::size_t agents_;
  Pool& pool_;
  std::unique_ptr<Memory> memory_;
};

/// Instruction set that the vectorised loops use on this machine.
const char* vector_unit();

}  // namespace faba::bench
