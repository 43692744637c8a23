#include "core/threads/urgent.h"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace faba {
namespace {

constexpr std::int32_t kNiceness = -10;
constexpr std::uint64_t kSlice =
    100'000;  // ns, the minimum of the scheduler: a thread with a shorter slice runs first

#if defined(SYS_sched_getattr) && defined(SYS_sched_setattr)
bool get(Urgent::Attributes& a) { return syscall(SYS_sched_getattr, 0, &a, sizeof a, 0) == 0; }
bool set(const Urgent::Attributes& a) { return syscall(SYS_sched_setattr, 0, &a, 0) == 0; }
#else
bool get(Urgent::Attributes&) { return false; }
bool set(const Urgent::Attributes&) { return false; }
#endif

}  // namespace

Urgent::Urgent() noexcept {
  Attributes before;
  if (!get(before) || before.policy != SCHED_OTHER) return;
  Attributes a = before;
  a.slice = kSlice;
  a.niceness = std::min(before.niceness, kNiceness);
  if (!set(a)) {
    a.niceness = before.niceness;
    if (!set(a)) return;
  }
  // A kernel without support for slices ignores them without an error.
  Attributes now;
  if (get(now) && (now.slice == kSlice || now.niceness < before.niceness)) before_ = before;
}

Urgent::~Urgent() {
  if (before_) (void)set(*before_);
}

bool Urgent::possible() noexcept {
  const Urgent here;
  return here.before_.has_value();
}

}  // namespace faba
