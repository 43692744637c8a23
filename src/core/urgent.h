#pragma once
#include <cstdint>
#include <optional>

namespace faba {

/// Its thread answers to a device: while this lives, it is run before others as far as the system lets it (a
/// lower niceness where that is allowed, a shorter slice of time where the scheduler knows one, Linux 6.12),
/// and afterwards as before. A thread that somebody has made a real-time one stays that. Only to be there
/// sooner: nothing may depend on it.
class Urgent {
 public:
  Urgent() noexcept;
  ~Urgent();
  Urgent(const Urgent&) = delete;
  Urgent& operator=(const Urgent&) = delete;

  /// Whether it is of any use here; otherwise others may step back instead.
  static bool possible() noexcept;

  /// What the kernel schedules a thread by, as it has it; the system's header and its C library's cannot be
  /// had together.
  struct Attributes {
    std::uint32_t size = sizeof(Attributes);
    std::uint32_t policy = 0;
    std::uint64_t flags = 0;
    std::int32_t niceness = 0;
    std::uint32_t priority = 0;
    std::uint64_t slice = 0, deadline = 0, period = 0;  ///< ns
  };

 private:
  std::optional<Attributes> before_;  ///< none when nothing was changed
};

}  // namespace faba
