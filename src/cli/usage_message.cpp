#include "cli/usage_message.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <utility>
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
      if (word == "--") continue;  // separates the options from the arguments
      if (word.size() < 2 || word.front() != '-') {
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

// The texts before and after the first `separator`; empty if it is not there or follows a space.
std::optional<std::pair<std::string, std::string>> word_before(const std::string& text,
                                                               const std::string& separator) {
  const auto at = text.find(separator);
  if (at == std::string::npos || at == 0 || text.find(' ') < at) return {};
  return std::pair{text.substr(0, at), text.substr(at + separator.size())};
}

}  // namespace

std::string usage_message(const CLI::App& app, const std::string& command, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> chain = given_commands(app);
  if (std::string text = unexpected(chain); !text.empty()) return text;
  // The class of an error of CLI11 does not tell these cases apart; its text does.
  std::string reason = error.what(), conversion = "Could not convert: ";
  if (reason == "A subcommand is required") return "a command is required";
  if (const auto p = word_before(reason, " is required"); p && p->second.empty())
    return fmt::format("{}: {} is missing; usage: {}", p->first,
                       p->first.front() == '-' ? "option" : "argument", usage_of(*chain.back(), command));
  if (const auto p = word_before(reason, " excludes "))
    return fmt::format("{} and {} cannot be combined; give only one of them", p->first, p->second);
  if (reason.starts_with(conversion)) {
    if (const auto p = word_before(reason.substr(conversion.size()), " = "))
      return fmt::format("{}: expected a number, got \"{}\"", p->first, p->second);
  } else if (const auto p = word_before(reason, ": ")) {
    if (p->second.ends_with(" missing")) return fmt::format("{}: a value is missing", p->first);
    if (p->second.starts_with("At Most 1 required but received"))
      return fmt::format("{}: may be given only once", p->first);
  }
  return reason;
}

}  // namespace faba::cli
