#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "core/error.h"
#include "core/process/installation.h"

namespace faba::cli {
namespace {

std::string program_name = "faba";
// A maximum of this size or more only prevents overflows and is not stated.
constexpr std::int64_t kNoLimit = std::int64_t(1) << 40;

/// CLI11 joins a type and its range by a colon, and has a name of its own for non-negative integers.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    if (text.starts_with(" UINT")) text.erase(1, 1);
    if (text.starts_with(" INT:")) text.replace(4, 1, ", ");
    return text;
  }
};

}  // namespace

CLI::App* verb(CLI::App& parent, CommandLine& line, const char* name, const char* description,
               const char* examples) {
  CLI::App* v = parent.add_subcommand(name, description);
  v->parse_complete_callback([&line, v] { line.common.verb = v; });
  v->add_flag("--json", line.common.json,
              "Print the result as one JSON object; standard output has no other text");
  v->add_flag("-q,--quiet", line.common.quiet, "Print no progress bar, no notes and no summary");
  v->footer(
      fmt::format("Examples:\n{}\n\nExit codes: 0 success, 2 invalid command line, scenario, coil system or "
                  "study file, 3 unreadable or unsuitable input, 4 camera or coil driver failure, 130 "
                  "interrupted, 1 any other error",
                  examples));
  return v;
}

std::string not_empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

std::function<std::string(const std::string&)> between(double min, double max) {
  return [min, max](const std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') return fmt::format("\"{}\" is not a number", text);
    if (value >= min && value <= max) return "";
    return fmt::format("{} is out of range; it must be between {:g} and {:g}", text, min, max);
  };
}

CLI::Validator integers(std::int64_t min, std::int64_t max) {
  return {[min, max](std::string& text) -> std::string {
            char* end = nullptr;
            errno = 0;
            const long long value = std::strtoll(text.c_str(), &end, 0);
            if (!text.empty() && *end == '\0' && errno == 0 && value >= min && value <= max) return "";
            if (max >= kNoLimit)
              return fmt::format("expected an integer of at least {}, got \"{}\"", min, text);
            return fmt::format("expected an integer between {} and {}, got \"{}\"", min, max, text);
          },
          max >= kNoLimit ? fmt::format("at least {}", min) : fmt::format("{} to {}", min, max)};
}

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

CLI::Validator one_of(const std::vector<std::string>& words) {
  return {[words](std::string& text) -> std::string {
            if (std::find(words.begin(), words.end(), text) != words.end()) return "";
            return fmt::format("\"{}\" is not one of {}", text, fmt::join(words, ", "));
          },
          fmt::format("{{{}}}", fmt::join(words, ","))};
}

CLI::Validator or_example(const std::string& folder) {
  return {[folder](std::string& text) -> std::string {
            text = file_or_example(text, folder).string();
            return "";
          },
          ""};
}

const std::string& program() { return program_name; }
void set_program(const char* name) { program_name = name; }

void print_stderr(const std::string& line) {
  std::fputs((line + '\n').c_str(), stderr);
  std::fflush(stderr);
}

const std::atomic<bool>& stop_requested() {
  static std::atomic<bool> stop{false};
  // Some senders signal a process and its group: a second signal within 0.5 s counts as the same request.
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
