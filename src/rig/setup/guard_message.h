#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "rig/setup/coil_guard.h"

namespace faba {

// What a program and the guard's process tell each other over a pair of local sockets, one datagram each.
// Both are of one build; the first datagram is text, the GuardSetup.

inline constexpr std::size_t kMostCoils = 16;
inline constexpr int kGuardDescriptor = 3;  ///< where the guard's process finds its end

struct ToGuard {
  enum class Kind : std::uint32_t { beat, arm, disarm, reset, request };
  Kind kind = Kind::beat;
  std::uint32_t coils = 0;
  std::uint64_t number = 0;
  double sent = 0, frame_t = 0;              ///< s
  std::array<double, kMostCoils> current{};  ///< A
};

/// Where the guard stands; sent after every request and every change, and ten times a second.
struct GuardReport {
  CoilGuard::State state = CoilGuard::State::disarmed;
  CoilGuard::Fault fault = CoilGuard::Fault::none;
  bool obeyed = true;        ///< the device took what it was told last
  std::uint64_t number = 0;  ///< of the request that it answers; 0 for none
  double sent = 0;           ///< s, when that was sent
  double done = 0;           ///< s, when the device had taken the voltages
  double heat = 0;           ///< of the warmest coil, 1 at its bound
  std::uint64_t passed = 0, refused = 0;
  std::array<double, kMostCoils> sensed{};  ///< A, not a number where nothing is told
  std::array<char, 240> reason{};           ///< of the fault, or why it will not be armed
  std::array<char, 480> log_failure{};      ///< file and reason, when the log could not be written on
};

}  // namespace faba
