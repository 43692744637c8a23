// The control loop in C++, for bench/python.py: SCENE FRAMES ROUNDS. Prints the shortest processor and wall
// time of a frame, s, and the state hash.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"

int main(int argc, char** argv) {
  using namespace faba;
  if (argc != 4) return 2;
  const Scenario s = read_scenario(read_toml(argv[1]), builtin_parts());
  const auto frames = std::strtoull(argv[2], nullptr, 10);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double cpu = kNever, wall = kNever;
  std::string hash;
  for (int round = 0; round < std::atoi(argv[3]); ++round) {
    Pool pool(1);
    Simulation simulation(s, *s.params.seed, pool);
    run_cycle(simulation.loop());  // touches all memory
    const auto started = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    for (std::uint64_t i = 0; i < frames; ++i) run_cycle(simulation.loop());
    cpu = std::min(cpu, double(std::clock() - used) / CLOCKS_PER_SEC / double(frames));
    wall = std::min(wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count() /
                              double(frames));
    hash = simulation.state_hash();
  }
  fmt::print("{} {} {}\n", cpu, wall, hash);
}
