#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace faba {

/// Where the standard input and output of a child process lead; the standard error goes to `log`, or is
/// discarded if that is empty.
struct ChildFiles {
  int in = -1, out = -1;  ///< file descriptors; -1: /dev/null
  std::filesystem::path log = {};
};

/// Starts a program, found by PATH. Throws Error(internal) when it cannot be started.
pid_t start_process(const std::vector<std::string>& words, const ChildFiles& files);

/// Exit code, or -signal, of a child process that has ended; empty while it runs. `wait`: returns when it has
/// ended.
std::optional<int> end_of_process(pid_t process, bool wait = false);
/// "exit code 3" or "signal 9".
std::string end_text(int end);

/// What a command wrote to its standard output, and its exit code.
struct CommandOutput {
  int exit = 0;
  std::string out;
};
/// Runs a command to its end; 127 when it is not found. Its standard error is discarded unless
/// `with_errors`, and then is part of `out`.
CommandOutput run_command(const std::vector<std::string>& words, bool with_errors = false);

/// The first and the last line of a log that is neither empty nor a warning.
std::string first_message(const std::filesystem::path& log);
std::string last_message(const std::filesystem::path& log);

/// Removes a log without messages.
void remove_if_empty(const std::filesystem::path& log);

/// Whether a program is found by PATH.
bool program_exists(const std::string& name);

}  // namespace faba
