#pragma once
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "core/process/installation.h"
#include "rig/setup/guard_message.h"
#include "rig/setup/guard_setup.h"

namespace faba {

/// Client of the guard: starts its process, sends heartbeats and requested currents. The guard de-energises
/// the coils when this object is destroyed or the program ends in any way.
class GuardLink {
 public:
  /// Throws Error(device) if the process cannot be started or the device cannot be opened. The guard starts
  /// disarmed.
  explicit GuardLink(const GuardSetup& setup,
                     const std::filesystem::path& guard = program_file("faba-coil-guard"));
  ~GuardLink();
  GuardLink(const GuardLink&) = delete;
  GuardLink& operator=(const GuardLink&) = delete;

  /// Each waits for the guard's answer. arm() throws Error(device) with the guard's reason if it refuses.
  void arm();
  void disarm() noexcept;
  void reset();
  /// Requests currents, A, one per coil. Does not wait; a later report has the result.
  /// Returns the number of the request, which the report repeats. Empty, without a request, while the coils
  /// are off after a command timeout; see deenergise_when_late().
  std::optional<std::uint64_t> request(std::span<const double> current, double frame_t);
  /// From now on the coils are de-energised without a fault shortly before the guard's command timeout: for
  /// callers whose camera or control cycle may be slow.
  void deenergise_when_late() { early_timeout_enabled_ = true; }
  /// True if the coils are off after a command timeout. Accepts requests again.
  bool clear_timeout();
  std::uint64_t command_timeouts() const { return command_timeouts_; }  ///< command timeouts so far
  /// The newest report.
  GuardReport report();
  /// Called by report() and request() for every report that answers a request: for latencies.
  std::function<void(const GuardReport&)> on_answer;
  pid_t process() const { return process_; }
  std::size_t coils() const { return coils_; }

 private:
  bool send_message(ToGuard m) const;
  void send_heartbeats(const std::stop_token& stop, double pause);
  bool drain();
  void mark_lost(const char* why);
  GuardReport wait_for(const std::function<bool(const GuardReport&)>& condition, double patience);
  void close_link() noexcept;

  int link_ = -1;
  pid_t process_ = -1;
  std::uint64_t coils_;
  double early_timeout_;  ///< s, time from a request until the coils are de-energised
  std::mutex mutex_;      ///< protects number_, energised_, coils_off_, requested_
  std::uint64_t number_ = 0;
  bool energised_ = false, coils_off_ = false;
  double requested_ = 0;  ///< s, time of the last request
  std::atomic<std::uint64_t> command_timeouts_ = 0;
  std::atomic<bool> early_timeout_enabled_ = false;
  GuardReport last_;
  double received_ = 0;  ///< s, arrival of last_
  bool lost_ = false;
  std::jthread heartbeat_;
};

}  // namespace faba
