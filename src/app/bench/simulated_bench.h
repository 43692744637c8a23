#pragma once
#include <atomic>
#include <filesystem>
#include <functional>

#include "app/scenario/scenario.h"
#include "core/threads/parallel.h"

namespace faba {

/// A simulated bench: the scenario's swarm in real time, its microscope as a camera, and its coils with an
/// amplifier, for programs in other processes (rig/bench/bench_socket.h). Its only input is the voltages, as
/// on a real bench. It logs the currents.
class SimulatedBench {
 public:
  struct Options {
    std::filesystem::path at;   ///< socket
    std::filesystem::path log;  ///< CSV of times, voltages and currents; empty: no log
    bool once = false;          ///< stop when all clients have disconnected
    const std::atomic<bool>* stop = nullptr;
    std::function<void()> ready = {};  ///< called when clients can connect
  };
  struct Summary {
    std::uint64_t frames = 0;     ///< number of frames
    std::uint64_t unfetched = 0;  ///< frames that the client of the camera did not fetch in time
    double behind = 0;            ///< s, maximum delay of the simulation behind the clock
  };
  /// Runs until `stop` is set. Throws Error(usage) for an unsuitable scenario, Error(device) for an error of
  /// a socket.
  static Summary run(Scenario s, std::uint64_t seed, Pool& pool, const Options& o);
};

}  // namespace faba
