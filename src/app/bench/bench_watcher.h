#pragma once
#include <memory>

#include "app/bench/bench_process.h"
#include "app/loop/loop.h"
#include "rig/camera.h"
#include "rig/setup/guard_message.h"

namespace faba {

/// Is shown every control cycle of a bench, for a live display. Called by the thread of the control loop, so
/// it must be fast.
class BenchWatcher {
 public:
  virtual ~BenchWatcher() = default;
  virtual void cycle(const Tick& t, const GuardReport& guard) = 0;
};

/// Devices that are open before a bench is: those of a live view in which the bench is used several times.
struct BenchDevices {
  std::shared_ptr<BenchProcess> simulated = nullptr;  ///< null: started if the scenario needs it
  std::shared_ptr<Camera> camera = nullptr;           ///< null: that of the scenario is opened
  BenchWatcher* watcher = nullptr;                    ///< must outlive the bench
};

}  // namespace faba
