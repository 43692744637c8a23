#pragma once
#include <sys/types.h>

#include <string>

namespace faba {

/// Waits until a child process that was asked to exit has exited. Sends SIGCONT first, because a stopped
/// process cannot exit, and SIGKILL after `timeout` s.
void end_child(pid_t process, double timeout) noexcept;

/// Quotes a word for a shell if necessary.
std::string shell_word(const std::string& word);

}  // namespace faba
