#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace faba {

// The simulated bench is a process of its own that listens on a local socket; camera and coil driver are its
// clients, each on a connection that begins with a BenchHello. All processes are of one build and one
// machine.

inline constexpr std::uint32_t kBenchVersion = 1;
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
  std::uint32_t set = 0;                      ///< the voltages below are to be put out
  std::array<double, kBenchOutputs> volts{};  ///< not a number: stays as it is
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
  std::uint64_t number = 0;  ///< counts all that were taken; gaps are frames that nobody fetched in time
  double t = 0;              ///< s, mid-exposure
  std::int32_t width = 0, height = 0;
  double rate = 0;  ///< Hz
};

/// A connection; closes itself. Every call gives up after `patience` s.
class BenchSocket {
 public:
  BenchSocket() = default;
  explicit BenchSocket(int descriptor) : descriptor_(descriptor) {}
  BenchSocket(BenchSocket&& other) noexcept;
  BenchSocket& operator=(BenchSocket&& other) noexcept;
  ~BenchSocket();
  /// Connects and says hello. Throws Error(device, path).
  static BenchSocket connect(const std::filesystem::path& path, BenchHello::Role role);
  /// A socket that listens; the name must be free. Throws Error(device, path).
  static BenchSocket listen(const std::filesystem::path& path);
  /// The next connection; an empty one after `patience` s.
  BenchSocket accept(double patience);

  enum class Got { all, nothing, closed };
  /// All of `bytes`, or nothing when none came in time; a message that stops half-way counts as closed.
  Got read(void* to, std::size_t bytes, double patience);
  bool write(const void* from, std::size_t bytes, double patience);

  bool hung_up() const;  ///< the other end is gone, whatever may still be there to read

  explicit operator bool() const { return descriptor_ >= 0; }
  void close();

 private:
  int descriptor_ = -1;
};

}  // namespace faba
