#pragma once
#include <filesystem>
#include <memory>

#include "core/file.h"
#include "rig/coil_driver.h"
#include "rig/setup/coil_calibration.h"
#include "rig/setup/guard_message.h"

namespace faba {

/// Main loop of the guard's process: owns the device, applies the currents of CoilGuard, and de-energises the
/// coils on every exit: when the client disconnects, on a signal, or when the driver fails.
class GuardLoop {
 public:
  /// `link`: a datagram socket. `log`: time-stamped events except accepted requests; may be null.
  GuardLoop(int link, CoilGuard guard, CoilWiring wiring, std::unique_ptr<CoilDriver> driver,
            std::unique_ptr<OutputFile> log);
  /// Returns at the end; false if the coils could not be de-energised.
  bool run();

 private:
  void receive();
  void execute(const ToGuard& m, double now);
  void serve(double now);
  void write_outputs(double now);
  void report(std::uint64_t number = 0, double sent = 0);
  void log_event(const std::string& what);
  void sync_log();
  bool deenergise();

  int link_;
  CoilGuard guard_;
  CoilWiring wiring_;
  std::unique_ptr<CoilDriver> driver_;
  std::unique_ptr<OutputFile> log_;
  std::string log_failure_;  ///< why the log was closed
  CoilGuard::State logged_state_ = CoilGuard::State::disarmed;
  std::vector<double> written_current_;  ///< A, at the outputs
  bool written_enable_ = false;          ///< enable state sent to the device
  bool write_ok_ = true;                 ///< the device accepted the last write
  bool stop_ = false;
  double done_ = 0;  ///< s, when the device had the voltages of the last message
  double written_ = 0, sensed_at_ = 0, reported_ = 0;  ///< s
  std::array<double, kMostCoils> sensed_{};
};

}  // namespace faba
