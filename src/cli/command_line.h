#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class FormatterBase;
class Validator;
}  // namespace CLI

namespace faba::cli {

/// Flags of all verbs.
struct Common {
  bool json = false;               ///< print one JSON object and no other text to standard output
  bool quiet = false;              ///< print no progress bar, no notes and no summary
  const CLI::App* verb = nullptr;  ///< the verb with the options that were given
};

/// State of a command line: the flags of all verbs, and the exit code.
struct CommandLine {
  Common common;
  int code = 0;
};

/// Adds all verbs with their options, in the order of the help. `line` must outlive the parsing.
void add_verbs(CLI::App& app, CommandLine& line);

/// Formatter of the help: the range of an integer in words, "INT, 1 to 64".
std::shared_ptr<CLI::FormatterBase> help_formatter();
/// Adds a verb to `parent`, with the flags and the help of all verbs.
CLI::App* verb(CLI::App& parent, CommandLine& line, const char* name, const char* description,
               const char* examples);
/// Check of an option: returns "" or the error message.
std::string not_empty(const std::string& text);
/// Check of a numeric option: a finite number between `min` and `max`.
std::function<std::string(const std::string&)> between(double min, double max);

/// Check of an option with an integer between `min` and `max`; the help shows the range.
CLI::Validator integers(std::int64_t min, std::int64_t max);

/// Check of an option with a list of permitted words; the help shows the list.
CLI::Validator one_of(const std::vector<std::string>& words);

/// An option with a file that may be named as an example of a folder, "scenes", "rigs" or "studies": its
/// value becomes the path of the file (file_or_example()).
CLI::Validator or_example(const std::string& folder);

/// The name under which the program was called, for commands in messages.
const std::string& program();
void set_program(const char* name);
/// Prints a line to standard error; errors are ignored.
void print_stderr(const std::string& line);

/// Becomes true on Ctrl-C, SIGTERM and SIGHUP; a second signal ends the program immediately. The first call
/// installs the signal handlers: without a call, the first signal ends the program.
const std::atomic<bool>& stop_requested();

}  // namespace faba::cli
