#include "cli/options/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "core/error.h"

namespace faba::cli {
namespace {

// Options that determine where and how a study is computed and printed.
constexpr std::array<std::string_view, 10> kNotOfTheStudy{
    "--help",   "--json",       "--quiet",   "--threads",   "--force",
    "--engine", "--engine-set", "--workers", "--scheduler", "--sshlogin"};

}  // namespace

std::vector<std::string> given_words(const CLI::App& verb, const std::vector<std::string_view>& without) {
  std::vector<std::string> words, options;
  for (const CLI::Option* o : verb.get_options()) {
    const std::string name = o->get_name();
    if (o->count() == 0 || std::ranges::find(kNotOfTheStudy, name) != kNotOfTheStudy.end() ||
        std::ranges::find(without, name) != without.end())
      continue;
    const std::vector<std::string>& values = o->results();
    if (o->get_positional())
      words.insert(words.end(), values.begin(), values.end());
    else if (o->get_expected_max() == 0)
      options.push_back(name);
    else if (o->get_delimiter() != '\0')
      options.push_back(fmt::format("{}={}", name, fmt::join(values, std::string(1, o->get_delimiter()))));
    else
      for (const std::string& value : values) options.push_back(fmt::format("{}={}", name, value));
  }
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

void parse_words(CLI::App& verb, const std::vector<std::string>& words, const std::string& where) {
  try {
    verb.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    throw Error(Errc::input, where, fmt::format("the stored options cannot be read: {}", e.what()));
  }
}

}  // namespace faba::cli
