#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace faba {

/// Who may arm the coils from a page. A permit is given to the page that steers, for one purpose; it is valid
/// for a short time and for one use. There is at most one permit. Old pages, repeated messages and pages of
/// an earlier lab therefore cannot arm the coils. Thread-safe.
class ArmingPermits {
 public:
  static constexpr double kValid = 15;  ///< s, time to read the question and to answer it; assumed

  /// The page that steers; 0: none. A permit of another page is void.
  void steering(std::uint64_t page);
  /// A new permit; the one before is void. Throws Error(usage) if the page does not steer.
  std::string issue(std::uint64_t page, const std::string& purpose, double now);
  /// Uses the permit up, in any case. Throws Error(usage) unless it is the present one, for this page and
  /// purpose, and still valid.
  void use(const std::string& permit, std::uint64_t page, const std::string& purpose, double now);
  /// The present permit becomes void, such as after the coils were switched off.
  void revoke();

 private:
  struct Permit {
    std::string secret, purpose;
    std::uint64_t page = 0;
    double issued = 0;  ///< s
  };
  std::mutex mutex_;
  std::uint64_t steering_ = 0;
  std::optional<Permit> permit_;
};

}  // namespace faba
