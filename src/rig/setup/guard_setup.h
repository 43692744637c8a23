#pragma once
#include <filesystem>

#include "rig/coil_driver.h"
#include "rig/setup/coil_calibration.h"
#include "rig/setup/coil_guard.h"

namespace faba {

/// Configuration of the guard's process, sent to it as JSON text.
struct GuardSetup {
  CoilDriverRegistry::PartType driver;
  std::vector<WiredCoil> coils;
  CoilGuard::Params guard;
  double frame_period = 1.0 / 15;  ///< s
  std::filesystem::path log;       ///< empty for none

  std::vector<CoilGuard::Bounds> bounds() const;
  DriverContext context() const;
  Json to_json() const;
  /// Throws Error(usage).
  static GuardSetup read(const Json& j, const CoilDriverRegistry& drivers);
};

}  // namespace faba
