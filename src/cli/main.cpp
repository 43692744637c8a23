#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>

#include "cli/command_line.h"
#include "core/schema.h"

namespace faba::cli {
namespace {

std::atomic<bool> stop{false};
std::string called_as = "faba";

void complain(const std::string& text) { tell("faba: error: " + text); }

// CLI11 would say that a verb is missing.
void check_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* v : app.get_subcommands({})) known.push_back(v->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw Error(Errc::usage, word, "is no verb" + suggestion(word, known));
}

int dispatch(int argc, char** argv) {
  if (argc > 0) called_as = argv[0];
  CLI::App app{
      "Faba, a laboratory for magnetotactic bacteria: simulate a swarm under coils, steer it, record it"};
  app.name("faba");
  app.set_version_flag("--version", "faba " FABA_VERSION);
  app.require_subcommand(1);
  app.footer("Each verb in full: faba VERB --help\nFirst steps: faba run scenes/steer.toml");
  CommandLine line;

  add_run_verbs(app, line);
  add_lab_verb(app, line);
  add_video_verbs(app, line);
  add_field_verbs(app, line);
  add_rig_verbs(app, line);
  add_study_verbs(app, line);
  add_help_verbs(app, line);

  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words[0] == "help") {  // as others have it: faba help run
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  if (!words.empty() && words[0].rfind('-', 0) != 0) check_verb(app, words[0]);
  std::string help = program();
  if (!words.empty() && words[0].rfind('-', 0) != 0) help += " " + words[0];
  if (words.size() > 1 && (words[0] == "field" || words[0] == "rig") && words[1].rfind('-', 0) != 0) {
    check_verb(*app.get_subcommand(words[0]), words[1]);
    help += " " + words[1];
  }
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    throw Error(Errc::usage, "", fmt::format("{} (see {} --help)", e.what(), help));
  }
  return line.code;
}

}  // namespace

CLI::App* verb(CLI::App& parent, CommandLine& line, const char* name, const char* does,
               const char* examples) {
  CLI::App* v = parent.add_subcommand(name, does);
  v->add_flag("--json", line.common.json, "One JSON object on standard output and nothing else there");
  v->add_flag("-q,--quiet", line.common.quiet, "No progress bar, no notes and no summary");
  v->footer(fmt::format(
      "Examples:\n{}\n\nExit codes: 0 done, 2 usage or scenario error, 3 unreadable or unsuitable input, "
      "4 camera or coil driver, 130 interrupted, 1 anything else",
      examples));
  return v;
}

std::string not_empty(const std::string& word) { return word.empty() ? "must not be empty" : ""; }

std::function<std::string(const std::string&)> between(double least, double most) {
  return [least, most](const std::string& word) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0') return fmt::format("\"{}\" is not a number", word);
    if (value >= least && value <= most) return "";
    return fmt::format("{} is out of range; it must be {:g} to {:g}", word, least, most);
  };
}

const std::atomic<bool>& stop_requested() {
  // Some senders signal a process and its group: a repeat within half a second is the same wish.
  static std::atomic<long> first_ms{0};
  const auto on_signal = [](int) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const long ms = now.tv_sec * 1000 + now.tv_nsec / 1000000;
    if (!stop.exchange(true))
      first_ms = ms;
    else if (ms - first_ms > 500)
      _Exit(int(Errc::interrupted));
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, on_signal);
  return stop;
}
const std::string& program() { return called_as; }

void tell(const std::string& line) {
  std::fputs((line + '\n').c_str(), stderr);
  std::fflush(stderr);
}

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) || std::strchr("_-./=:,+@%", c);
  });
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace faba::cli

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of writing
  std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves early is an error of writing, not a death
  try {
    const int code = faba::cli::dispatch(argc, argv);
    if (std::fflush(stdout) != 0)
      throw faba::Error(faba::Errc::internal, "standard output", "cannot be written");
    return code;
  } catch (const faba::Error& e) {
    faba::cli::complain(e.what());
    return int(e.code());
  } catch (const std::bad_alloc&) {
    faba::cli::complain("out of memory; fewer cells, a smaller arena or a shorter run may fit");
  } catch (const std::exception& e) {
    faba::cli::complain(e.what());
  }
  return int(faba::Errc::internal);
}
