#pragma once
#include <filesystem>
#include <memory>

#include "core/file.h"
#include "rig/coil_driver.h"
#include "rig/setup/coil_calibration.h"
#include "rig/setup/guard_message.h"

namespace faba {

/// The guard's process: owns the device, does what CoilGuard says, and puts the coils at rest on every way
/// out: when the other end of the link is gone, on a signal, when the driver fails.
class GuardLoop {
 public:
  /// `link`: a datagram socket. `log`: lines with times, of everything but ordinary requests; may be null.
  GuardLoop(int link, CoilGuard guard, CoilWiring wiring, std::unique_ptr<CoilDriver> driver,
            std::unique_ptr<OutputFile> log);
  /// Returns when it is over and the outputs are at rest, or could not be brought there: then false.
  bool run();

 private:
  void listen();
  void obey(const ToGuard& m, double now);
  void serve(double now);
  void put_out(double now);
  void report(std::uint64_t number = 0, double sent = 0);
  void note(const std::string& what);
  bool rest();

  int link_;
  CoilGuard guard_;
  CoilWiring wiring_;
  std::unique_ptr<CoilDriver> driver_;
  std::unique_ptr<OutputFile> log_;
  std::string log_failure_;  ///< why there is no log any more
  CoilGuard::State shown_ = CoilGuard::State::disarmed;
  std::vector<double> put_;  ///< A, at the outputs
  bool armed_ = false;       ///< as the device was told
  bool obeyed_ = true;       ///< the device took what it was told last
  bool over_ = false;
  double done_ = 0;  ///< s, when the device had what the last message asked for
  double written_ = 0, sensed_at_ = 0, reported_ = 0;  ///< s
  std::array<double, kMostCoils> sensed_{};
};

}  // namespace faba
