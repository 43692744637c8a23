#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>

namespace faba {

/// Path of one of Faba's programs and modules: "faba", "faba-coil-guard", "faba-capture.so". They are in one
/// folder: that of this program, unless set_program_folder() names another. "faba" is then this program,
/// whatever its file is named. Throws Error(internal).
std::filesystem::path program_file(const std::string& name);

/// For a process that is not one of them, such as a Python interpreter. To be called before other threads
/// are started.
void set_program_folder(const std::filesystem::path& folder);

/// Waits until a child process that was asked to exit has exited. Sends SIGCONT first, because a stopped
/// process cannot exit, and SIGKILL after `timeout` s.
void end_child(pid_t process, double timeout) noexcept;

/// Quotes a word for a shell if necessary.
std::string shell_word(const std::string& word);

}  // namespace faba
