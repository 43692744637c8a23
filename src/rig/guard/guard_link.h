#pragma once
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "rig/setup/guard_message.h"
#include "rig/setup/guard_setup.h"

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
  /// Returns its number, by which a report answers it; none, and nothing is handed on, while the coils rest
  /// as deenergise_when_late() says.
  std::optional<std::uint64_t> request(std::span<const double> current, double frame_t);
  /// From now on the coils come to rest shortly before the guard would find that no command came in time,
  /// which is a fault: for who may wait for a camera, or think, for longer.
  void deenergise_when_late() { patient_ = true; }
  /// Whether they rest; from now on requests are handed on again.
  bool wake();
  std::uint64_t command_timeouts() const { return command_timeouts_; }  ///< how often they came to rest so
  /// The newest report.
  GuardReport report();
  /// Called with every report of a request as report() or request() comes across it: for latencies.
  std::function<void(const GuardReport&)> on_answer;
  pid_t process() const { return process_; }
  std::size_t coils() const { return coils_; }

 private:
  bool tell(ToGuard m) const;
  void live(const std::stop_token& stop, double pause);
  bool drain();
  void lose(const char* why);
  GuardReport wait_for(const std::function<bool(const GuardReport&)>& enough, double patience);
  void close_link() noexcept;

  int link_ = -1;
  pid_t process_ = -1;
  std::uint64_t coils_;
  double patience_;   ///< s after a request until the coils come to rest
  std::mutex mutex_;  ///< of what both threads touch: number_, flows_, coils_off_, asked_
  std::uint64_t number_ = 0;
  bool flows_ = false, coils_off_ = false;
  double asked_ = 0;  ///< s, when the last request was made
  std::atomic<std::uint64_t> command_timeouts_ = 0;
  std::atomic<bool> patient_ = false;
  GuardReport last_;
  double heard_ = 0;  ///< s, when it came
  bool gone_ = false;
  std::jthread heart_;
};

}  // namespace faba
