#pragma once
#include <atomic>
#include <filesystem>
#include <functional>

#include "app/scenario/scenario.h"
#include "core/parallel.h"

namespace faba {

/// A bench that is not there: the scenario's swarm in real time, its microscope as a camera and its coils
/// behind an amplifier, for programs in other processes (rig/bench/bench_socket.h). It obeys voltages and
/// nothing else, as a bench does, and keeps a log of what flowed when.
class SimulatedBench {
 public:
  struct Options {
    std::filesystem::path at;   ///< socket
    std::filesystem::path log;  ///< CSV of times, voltages and currents; empty for none
    bool once = false;          ///< ends when those that came have gone
    const std::atomic<bool>* stop = nullptr;
    std::function<void()> ready = {};  ///< called when it can be connected to
  };
  /// How it went.
  struct Summary {
    std::uint64_t frames = 0;     ///< taken
    std::uint64_t unfetched = 0;  ///< that the camera's client was too slow for
    double behind = 0;            ///< s, most that the simulation was behind the clock
  };
  /// Works until told to stop. Throws Error(usage) for a scenario that does not fit, Error(device) for a
  /// socket.
  static Summary run(Scenario s, std::uint64_t seed, Pool& pool, const Options& o);
};

}  // namespace faba
