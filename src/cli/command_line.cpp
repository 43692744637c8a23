#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "core/error.h"

namespace faba::cli {
namespace {

std::string called_by = "faba";

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

const std::string& program() { return called_by; }
void set_program(const char* called_as) { called_by = called_as; }

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

const std::atomic<bool>& stop_requested() {
  static std::atomic<bool> stop{false};
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

}  // namespace faba::cli
