#pragma once
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "rig/guard_message.h"
#include "rig/guard_setup.h"

namespace faba {

/// Where the guard's program is: beside this one.
std::filesystem::path guard_program();

/// The program's end of the guard: begins its process, tells it that the program lives, hands it currents.
/// When this goes, however it goes, the coils come to rest.
class GuardLink {
 public:
  /// Throws Error(device) when the process cannot be begun or the device not be opened. The device is
  /// disarmed.
  explicit GuardLink(const GuardSetup& setup, const std::filesystem::path& guard = guard_program());
  ~GuardLink();
  GuardLink(const GuardLink&) = delete;
  GuardLink& operator=(const GuardLink&) = delete;

  /// Each waits for the guard's word. arm() throws Error(device) with the guard's reason when it will not.
  void arm();
  void disarm() noexcept;
  void reset();
  /// Hands on currents, A, one per coil. Does not wait; what becomes of them a later report tells.
  /// Returns its number, by which a report answers it.
  std::uint64_t request(std::span<const double> current, double frame_t);
  /// The newest report.
  GuardReport report();
  /// Called with every report of a request as report() or request() comes across it: for latencies.
  std::function<void(const GuardReport&)> on_answer;
  pid_t process() const { return process_; }
  std::size_t coils() const { return coils_; }
  double command_deadline() const { return command_deadline_; }  ///< s

 private:
  bool tell(ToGuard m);
  bool drain();
  GuardReport wait_for(const std::function<bool(const GuardReport&)>& enough);
  void close_link() noexcept;

  int link_ = -1;
  pid_t process_ = -1;
  std::uint64_t number_ = 0, coils_;
  double command_deadline_;  ///< s
  GuardReport last_;
  bool gone_ = false;
  std::jthread heart_;
};

}  // namespace faba
