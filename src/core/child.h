#pragma once
#include <sys/types.h>

namespace faba {

/// Waits for a child process that has been asked to end; one that was stopped is let go on, so that it can.
/// After `patience` s it is killed.
void end_child(pid_t process, double patience) noexcept;

}  // namespace faba
