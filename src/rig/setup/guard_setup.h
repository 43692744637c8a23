#pragma once
#include <filesystem>

#include "rig/coil_driver.h"
#include "rig/setup/coil_calibration.h"
#include "rig/setup/coil_guard.h"

namespace faba {

/// All that the guard's process must know; goes to it as text.
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
