#include "core/urgent.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace faba {
namespace {

constexpr std::int32_t kNiceness = -10;
constexpr std::uint64_t kSlice =
    100'000;  // ns, the least that the scheduler takes: who asks for less goes first

// As the kernel has it; the system's header and its C library's cannot be had together.
struct Attributes {
  std::uint32_t size = sizeof(Attributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t niceness = 0;
  std::uint32_t priority = 0;
  std::uint64_t slice = 0, deadline = 0, period = 0;
};

bool set(std::int32_t niceness, std::uint64_t slice) {
  const Attributes a{.niceness = niceness, .slice = slice};
  return syscall(SYS_sched_setattr, 0, &a, 0) == 0;
}

}  // namespace

Urgent::Urgent() noexcept : niceness_(getpriority(PRIO_PROCESS, id_t(gettid()))) {
  if (!set(kNiceness, kSlice)) (void)set(niceness_, kSlice);
}

Urgent::~Urgent() { (void)set(niceness_, 0); }

}  // namespace faba
