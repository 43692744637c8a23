#pragma once
#include <functional>
#include <string>

#include "cli/verbs.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// What comes of a command line while it is read: the flags that all verbs share, and the exit code.
struct CommandLine {
  Common common;
  int code = 0;
};

/// A verb below `parent`, with the flags and the help that every verb has.
CLI::App* verb(CLI::App& parent, CommandLine& line, const char* name, const char* does, const char* examples);
/// A check for options: "" or the complaint.
std::string not_empty(const std::string& word);
/// A check for options that are numbers: finite, `least` or more, and `most` or less.
std::function<std::string(const std::string&)> between(double least, double most);

// The verbs with their options, in the order of the help. `line` outlives the parsing.

void add_run_verbs(CLI::App& app, CommandLine& line);  ///< run, resume
void add_lab_verb(CLI::App& app, CommandLine& line);
void add_video_verbs(CLI::App& app, CommandLine& line);  ///< what measures pictures and videos
void add_field_verbs(CLI::App& app, CommandLine& line);  ///< field ...
void add_rig_verbs(CLI::App& app, CommandLine& line);    ///< rig ...
void add_study_verbs(CLI::App& app, CommandLine& line);  ///< what takes many simulations
void add_help_verbs(CLI::App& app, CommandLine& line);   ///< parts, schema, doctor

}  // namespace faba::cli
