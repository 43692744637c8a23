#pragma once
#include <optional>

#include "rig/camera.h"
#include "rig/setup/amplifier.h"
#include "rig/setup/guard_setup.h"

namespace faba {

/// The table [rig.bench]: what a simulated bench is made of, and how it fails.
struct BenchParams {
  Amplifier::Params amplifier;
  std::optional<double> freeze_after;  ///< s
  static Schema<BenchParams> schema();
};

/// The table [rig.step_response]: how step responses are recorded (theory A14; 3.4.1 and 3.4.2 of the
/// thesis).
struct StepResponseParams {
  double direction = 180;                      ///< deg, in the picture
  double field = 1e-3;                         ///< T
  double gather = 20, before = 1, record = 6;  ///< s
  int repeat = 1;
  double every = 60;  ///< s
  static Schema<StepResponseParams> schema();
};

/// The table [rig]: the bench that a scenario can be run on.
struct RigSetup {
  struct Params {
    double camera_timeout = 2;    ///< s
    std::optional<double> delay;  ///< s, from mid-exposure to the command
    static Schema<Params> schema();
  };
  Params params;
  CameraRegistry::PartType camera;
  CoilDriverRegistry::PartType driver;
  std::vector<WiredCoil> coils;  ///< as many as the field has
  CoilGuard::Params guard;
  BenchParams bench;
  StepResponseParams step_response;

  /// `coils`: of the field. Throws Error(usage).
  static RigSetup read(const Node& n, std::size_t coils, const CameraRegistry& cameras,
                       const CoilDriverRegistry& drivers);
  Json resolved() const;
  static Json json_schema();  ///< but for camera and driver
  GuardSetup guard_setup(double frame_period, const std::filesystem::path& log) const;
  /// Largest current of each coil that wiring and guard allow, A.
  std::vector<double> max_current() const;
  /// The simulated bench that camera or driver are to be found at was not named: one must be begun.
  bool needs_bench() const;
  /// The same with that bench named.
  RigSetup at(const std::string& socket, const CameraRegistry& cameras,
              const CoilDriverRegistry& drivers) const;
};

}  // namespace faba
