#pragma once
#include <atomic>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace faba::cli {

/// What every verb takes.
struct Common {
  bool json = false;   ///< one JSON object on standard output and nothing else there
  bool quiet = false;  ///< no progress bar, no notes, no summary
};

/// What comes of a command line while it is read: the flags that all verbs share, and the exit code.
struct CommandLine {
  Common common;
  int code = 0;
};

/// All verbs with their options, in the order of the help. `line` outlives the parsing.
void add_verbs(CLI::App& app, CommandLine& line);

/// A verb below `parent`, with the flags and the help that every verb has.
CLI::App* verb(CLI::App& parent, CommandLine& line, const char* name, const char* does, const char* examples);
/// A check for options: "" or the complaint.
std::string not_empty(const std::string& word);
/// A check for options that are numbers: finite, `least` or more, and `most` or less.
std::function<std::string(const std::string&)> between(double least, double most);

/// The program as it was called, for commands that a user is told to type.
const std::string& program();
void set_program(const char* called_as);
/// A line on standard error; lost when nobody can be told.
void tell(const std::string& line);
/// A word as a shell takes it for one: in quotes where it needs them.
std::string shell_word(const std::string& word);

/// Becomes true on Ctrl-C and SIGTERM; the second Ctrl-C ends the program at once. Only who asks has to look
/// at it: a program that never does is ended by the first signal.
const std::atomic<bool>& stop_requested();

}  // namespace faba::cli
