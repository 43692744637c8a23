#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/parallel.h"

namespace faba::bench {

/// What the machine cannot do without: the random numbers, elementary functions and memory traffic of a step,
/// each in a loop of its own that is vectorised as the models' loops are. One unit is what one agent needs.
/// - `philox`: one block, four random words
/// - `sincos`, `log`: one value, from and to the first cache
/// - `traffic`: positions and headings read and written, one constant read, 36 bytes, over all agents
/// - `triad`: a = b + s c, 12 bytes
class Machine {
 public:
  Machine(std::size_t agents, Pool& pool);
  ~Machine();
  static const std::vector<std::string>& names();
  /// Goes `times` times over all agents.
  void run(const std::string& name, int times);
  /// What the two Box-Muller pairs of one agent-step take: 1 philox + 2 sincos + 2 log + traffic.
  static constexpr int kSinCos = 2, kLog = 2;

 private:
  struct Memory;
  std::size_t agents_;
  Pool& pool_;
  std::unique_ptr<Memory> memory_;
};

/// Instruction set that the vectorised loops run on here.
const char* vector_unit();

}  // namespace faba::bench
