#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "rig/setup/coil_guard.h"

namespace faba {

// Messages between the program and the guard's process over a pair of local sockets, one datagram each. Both
// come from one build. The first datagram is text: the GuardSetup.

inline constexpr std::size_t kMostCoils = 16;
inline constexpr int kGuardDescriptor = 3;  ///< descriptor of the socket in the guard's process

struct ToGuard {
  enum class Kind : std::uint32_t { heartbeat, arm, disarm, reset, request };
  Kind kind = Kind::heartbeat;
  std::uint32_t coils = 0;
  std::uint64_t number = 0;
  double sent = 0, frame_t = 0;              ///< s
  std::array<double, kMostCoils> current{};  ///< A
};

/// Status of the guard; sent after every request and every change, and ten times per second.
struct GuardReport {
  CoilGuard::State state = CoilGuard::State::disarmed;
  CoilGuard::Fault fault = CoilGuard::Fault::none;
  bool write_ok = true;      ///< the device accepted the last write
  std::uint64_t number = 0;  ///< number of the answered request; 0 for none
  double sent = 0;           ///< s, when the request was sent
  double done = 0;           ///< s, when the device had the voltages
  double heat = 0;           ///< thermal load of the warmest coil, relative to its limit
  std::uint64_t passed = 0, refused = 0;
  std::array<double, kMostCoils> sensed{};  ///< A; NaN for coils without an input
  std::array<char, 240> reason{};           ///< reason of the fault, or why the guard refuses to arm
  std::array<char, 480> log_failure{};      ///< file and reason, if writing the log failed
};

}  // namespace faba
