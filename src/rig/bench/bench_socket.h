#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace faba {

// The simulated bench is a separate process that listens on a local socket. Camera and coil driver are its
// clients, each with one connection that starts with a BenchHello. All processes come from one build and run
// on one machine.

inline constexpr std::uint32_t kBenchVersion = 2;
inline constexpr std::size_t kBenchOutputs = 16;

struct BenchHello {
  enum class Role : std::uint32_t { coils = 1, camera = 2 };
  std::uint32_t version = kBenchVersion;
  Role role = Role::coils;
};
/// Driver to bench.
struct BenchVolts {
  std::uint32_t outputs = 0;
  std::uint32_t enable = 0;
  std::uint32_t tell = 0;                     ///< answer with a BenchSense
  std::uint32_t set = 0;                      ///< set the outputs to the voltages below
  std::array<double, kBenchOutputs> volts{};  ///< NaN: unchanged
};
/// Bench to driver.
struct BenchSense {
  std::array<double, kBenchOutputs> volts{};
};
/// Bench to driver, once, after the hello.
struct BenchDevice {
  std::uint32_t outputs = 0;
  std::uint32_t enable_line = 1;
};
/// Bench to camera, before the width * height bytes of each frame.
struct BenchFrame {
  std::uint64_t number = 0;  ///< counts all frames taken; gaps are frames that no client fetched in time
  double t = 0;              ///< s, mid-exposure
  std::int32_t width = 0, height = 0;
  double rate = 0;  ///< Hz
  std::uint32_t corrupt = 0;
};

/// A connection, closed by the destructor. Every call times out after `patience` s.
class BenchSocket {
 public:
  BenchSocket() = default;
  explicit BenchSocket(int descriptor) : descriptor_(descriptor) {}
  BenchSocket(BenchSocket&& other) noexcept;
  BenchSocket& operator=(BenchSocket&& other) noexcept;
  ~BenchSocket();
  /// Connects and sends a BenchHello. Throws Error(device, path).
  static BenchSocket connect(const std::filesystem::path& path, BenchHello::Role role);
  /// A listening socket; `path` must not exist. Throws Error(device, path).
  static BenchSocket listen(const std::filesystem::path& path);
  /// The next connection; an empty one on timeout.
  BenchSocket accept(double patience);

  enum class Got { all, nothing, closed };
  /// all: `bytes` were read; nothing: timeout; closed: connection closed, or message incomplete.
  Got read(void* to, std::size_t bytes, double patience);
  bool write(const void* from, std::size_t bytes, double patience);

  bool hung_up() const;  ///< the peer disconnected; unread data may remain

  explicit operator bool() const { return descriptor_ >= 0; }
  void close();

 private:
  int descriptor_ = -1;
};

}  // namespace faba
