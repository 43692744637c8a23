#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <new>

#include "cli/command_line.h"
#include "cli/process_memory.h"
#include "cli/usage_message.h"
#include "core/process/installation.h"
#include "core/schema.h"
#include "core/toml.h"

namespace faba::cli {
namespace {

void print_error(const std::string& text) { print_stderr("faba: error: " + text); }

// With --json also the parts of the error, for programs.
void print_error(const Error& e, bool json) {
  print_error(e.what());
  if (json)
    fmt::print("{}\n",
               Json{{"error", {{"code", int(e.code())}, {"where", e.where()}, {"what", e.reason()}}}}.dump(
                   -1, ' ', false, Json::error_handler_t::replace));
}

std::string help_footer() {
  std::string text = "Options of a command: faba COMMAND --help\nFirst run: faba run steer";
  const std::filesystem::path pages = examples_folder() / "docs" / "index.html";
  std::error_code ec;
  if (std::filesystem::exists(pages, ec)) text += "\nManual: man faba, " + pages.string();
  return text;
}

// The message of CLI11 would be that a verb is missing.
void check_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* v : app.get_subcommands({})) known.push_back(v->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw Error(Errc::usage, "", fmt::format("unknown command \"{}\"{}", word, suggestion(word, known)));
}

// Checks the verb and returns it with the name of the program: "faba field map".
std::string command_of(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string command = program();
  const CLI::App* at = &app;
  for (const std::string& word : arguments) {
    if (word.rfind('-', 0) == 0 || at->get_subcommands({}).empty()) break;
    check_verb(*at, word);
    command += " " + word;
    at = at->get_subcommand(word);
  }
  return command;
}

int dispatch(int argc, char** argv) {
  if (argc > 0) set_program(argv[0]);
  CLI::App app{
      "Faba, a laboratory for magnetotactic bacteria: simulate, steer and record swarms in magnetic fields"};
  app.name("faba");
  app.formatter(help_formatter());
  app.set_version_flag("--version", "faba " FABA_VERSION);
  app.require_subcommand(1);
  app.group("Commands");  // heading of the list of commands, also in the help of all commands
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.footer(help_footer());
  CommandLine line;
  add_verbs(app, line);

  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments[0] == "help") {  // faba help run
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  const std::string command = command_of(app, arguments);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    throw Error(Errc::usage, "", fmt::format("{} (see {} --help)", usage_message(app, command, e), command));
  }
  return line.code;
}

int run(int argc, char** argv) {
  const bool json =
      std::any_of(argv + 1, argv + argc, [](const char* word) { return std::string("--json") == word; });
  try {
    const int code = dispatch(argc, argv);
    if (std::fflush(stdout) != 0) throw Error(Errc::internal, "standard output", "cannot be written");
    return code;
  } catch (const Error& e) {
    print_error({e.code(), e.where(), e.reason() + example_advice(e)}, json);
    return int(e.code());
  } catch (const std::bad_alloc&) {
    print_error("out of memory; reduce the number of cells, the arena or the duration");
  } catch (const std::exception& e) {
    print_error(e.what());
  }
  return int(Errc::internal);
}

}  // namespace
}  // namespace faba::cli

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is reported as a write error
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is reported as a write error
  faba::cli::keep_freed_memory();
  faba::cli::end_process(faba::cli::run(argc, argv));
}
