#pragma once
#include <cstdint>
#include <optional>

namespace faba {

/// Raises the scheduling priority of its thread, which serves a device, during the life of the object: a
/// lower niceness if permitted, and a shorter time slice if the scheduler supports it (Linux 6.12). The
/// destructor restores the previous attributes. Real-time threads are not changed. This reduces latency only;
/// nothing may depend on it.
class Urgent {
 public:
  Urgent() noexcept;
  ~Urgent();
  Urgent(const Urgent&) = delete;
  Urgent& operator=(const Urgent&) = delete;

  /// Whether the priority can be raised on this system; otherwise other threads can lower theirs.
  static bool possible() noexcept;

  /// struct sched_attr of the kernel, whose header cannot be included together with that of the C library.
  struct Attributes {
    std::uint32_t size = sizeof(Attributes);
    std::uint32_t policy = 0;
    std::uint64_t flags = 0;
    std::int32_t niceness = 0;
    std::uint32_t priority = 0;
    std::uint64_t slice = 0, deadline = 0, period = 0;  ///< ns
  };

 private:
  std::optional<Attributes> before_;  ///< empty if nothing was changed
};

}  // namespace faba
