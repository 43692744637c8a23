#pragma once
#include <optional>

#include "rig/camera.h"
#include "rig/setup/amplifier.h"
#include "rig/setup/guard_setup.h"

namespace faba {

/// The table [rig.bench]: electronics and simulated faults of a simulated bench.
struct BenchParams {
  Amplifier::Params amplifier;
  std::optional<double> freeze_after;  ///< s
  int corrupt_one_of = 0;              ///< one of this number of frames arrives damaged; 0: none
  static Schema<BenchParams> schema();
};

/// The table [rig.step_response]: recording of step responses (theory A14; 3.4.1 and 3.4.2 of the
/// thesis).
struct StepResponseParams {
  double direction = 180;                      ///< deg, in the image
  double field = 1e-3;                         ///< T
  double gather = 20, before = 1, record = 6;  ///< s
  int repeat = 1;
  double every = 60;  ///< s
  static Schema<StepResponseParams> schema();
};

/// The table [rig]: the bench for a scenario.
struct RigSetup {
  struct Params {
    double camera_timeout = 2;    ///< s
    std::optional<double> delay;  ///< s, from mid-exposure to the command
    static Schema<Params> schema();
  };
  Params params;
  CameraRegistry::PartType camera;
  CoilDriverRegistry::PartType driver;
  std::vector<WiredCoil> coils;  ///< one per coil of the field
  CoilGuard::Params guard;
  BenchParams bench;
  StepResponseParams step_response;

  /// `coils`: of the field. Throws Error(usage).
  static RigSetup read(const Node& n, std::size_t coils, const CameraRegistry& cameras,
                       const CoilDriverRegistry& drivers);
  Json resolved() const;
  static Json json_schema();  ///< without camera and driver
  GuardSetup guard_setup(double frame_period, const std::filesystem::path& log) const;
  /// Maximum current of each coil permitted by wiring and guard, A.
  std::vector<double> max_current() const;
  /// Camera or driver are simulated without `at`: a simulated bench must be started.
  bool needs_bench() const;
  /// A copy that uses the simulated bench at `socket`.
  RigSetup at(const std::string& socket, const CameraRegistry& cameras,
              const CoilDriverRegistry& drivers) const;
};

}  // namespace faba
