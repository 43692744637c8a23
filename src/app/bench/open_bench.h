#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/bench/bench_controls.h"
#include "app/bench/bench_process.h"
#include "rig/bench/bench_rig.h"
#include "rig/bench/device_list.h"

namespace faba {

/// The bench of a scenario, opened: its camera gives pictures and its coils are disarmed. Several runs may
/// follow one another on it.
class OpenBench {
 public:
  /// Begins a simulated bench when the scenario names none. `s.camera.rate` becomes the camera's. Throws
  /// Error(usage) for a scenario that does not fit, before anything is opened where this can be known;
  /// Error(device).
  enum class Open { all, coils };
  OpenBench(Scenario& s, std::uint64_t seed, Open what = Open::all);

  /// Camera and coils as a rig, made when first asked for; the guard's log goes to `log` then, none when
  /// empty. Throws Error(device).
  BenchRig& rig(const std::filesystem::path& log);
  /// Throws Error(device) when the coils' driver cannot be opened, so that nothing need be written then.
  void try_coils() const;
  /// How long this machine takes from mid-exposure of a picture to the command that the scenario's parts
  /// answer it with, s: the median of a few pictures. Coils stay disarmed. 0 where commands move nothing or
  /// the camera waits for them. Throws Error(device).
  double delay(const Scenario& s);
  const std::shared_ptr<Camera>& camera() const { return camera_; }  ///< null when not opened
  /// What a GuardLink needs, for those who want coils and no camera.
  GuardSetup guard_setup(const std::filesystem::path& log) const {
    return setup_.guard_setup(frame_period_, log);
  }

 private:
  std::unique_ptr<BenchProcess> process_;
  RigSetup setup_;
  double frame_period_ = 0;  ///< s
  std::shared_ptr<Camera> camera_;
  std::unique_ptr<BenchRig> rig_;
};

/// What a bench is like.
struct BenchCheck {
  std::string camera, driver;  ///< the parts' names
  int width_px = 0, height_px = 0;
  std::optional<double> rate_hz;  ///< of the frames that came; empty for a single one
  std::uint64_t frames = 0, dropped = 0, corrupt = 0;
  double age_s = 0;              ///< of the last frame: from mid-exposure until it is in the program
  double delay_s = 0;            ///< see OpenBench::delay
  std::string guard;             ///< its state in a word
  std::string cannot_arm;        ///< why the coils cannot be armed; empty when they can
  std::vector<double> sensed_a;  ///< current of each coil, A; NaN where it is not measured
  /// Where the estimator sees a swarm; empty when it sees none.
  struct Swarm {
    double cells = 0;
    Vec2 centroid_px;
  };
  std::optional<Swarm> swarm;
};

/// Looks at a bench without letting current flow: pictures for so many seconds, what the guard says, and
/// where the estimator sees a swarm. For `faba rig check`.
BenchCheck check_bench(Scenario s, std::uint64_t seed, double seconds);

}  // namespace faba
