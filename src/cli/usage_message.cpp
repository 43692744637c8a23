#include "cli/usage_message.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <regex>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba::cli {
namespace {

// The program, its command and the command of that, as given.
std::vector<const CLI::App*> given_commands(const CLI::App& app) {
  std::vector<const CLI::App*> chain{&app};
  while (!chain.back()->get_subcommands().empty()) chain.push_back(chain.back()->get_subcommands().front());
  return chain;
}

// An unknown option of one of the commands, else a surplus argument; empty if there is neither.
std::string unexpected(const std::vector<const CLI::App*>& chain) {
  std::string surplus;
  for (const CLI::App* at : chain)
    for (const std::string& word : at->remaining()) {
      if (word.size() < 2 || word.front() != '-' || word == "--") {
        if (surplus.empty()) surplus = fmt::format("unexpected argument \"{}\"", word);
        continue;
      }
      const std::string option = word.substr(0, word.find('='));
      std::vector<std::string> known;
      for (const CLI::Option* o : at->get_options())
        for (const std::string& name : o->get_lnames()) known.push_back("--" + name);
      std::string advice = suggestion(option, known);
      if (!at->get_subcommands().empty())
        advice = "; options follow the command";
      else if (advice.starts_with("; known"))  // the list is in the help
        advice.clear();
      return fmt::format("unknown option {}{}", option, advice);
    }
  return surplus;
}

// "faba flow A [B]"
std::string usage_of(const CLI::App& app, const std::string& command) {
  std::string usage = command;
  for (const CLI::Option* o : app.get_options()) {
    if (o->get_positional()) {
      std::string name = o->get_name();
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return char(std::toupper(c)); });
      if (o->get_expected_max() > 1) name += "...";
      usage += o->get_required() ? " " + name : " [" + name + "]";
    } else if (o->get_required()) {
      usage += fmt::format(" {} {}", o->get_name(), o->get_type_name());
    }
  }
  return usage;
}

}  // namespace

std::string usage_message(const CLI::App& app, const std::string& command, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> chain = given_commands(app);
  if (std::string text = unexpected(chain); !text.empty()) return text;
  std::string reason = error.what();
  if (reason == "A subcommand is required") return "a command is required";
  std::smatch part;
  const auto matches = [&](const char* pattern) {
    return std::regex_match(reason, part, std::regex(pattern));
  };
  if (matches("(\\S+) is required"))
    return fmt::format("{}: {} is missing; usage: {}", part[1].str(),
                       part[1].str().front() == '-' ? "option" : "argument",
                       usage_of(*chain.back(), command));
  if (matches("(\\S+): \\d+ required .* missing"))
    return fmt::format("{}: a value is missing", part[1].str());
  if (matches("(\\S+): At Most 1 required but received \\d+"))
    return fmt::format("{}: may be given only once", part[1].str());
  if (matches("Could not convert: (\\S+) = (.*)"))
    return fmt::format("{}: expected a number, got \"{}\"", part[1].str(), part[2].str());
  return reason;
}

}  // namespace faba::cli
