#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace faba::cli {

/// The words that were given after the name of a verb, first those without an option, so that parse_words()
/// gives the same options again in another process. Options of all verbs, of engines, and those in `without`
/// are left out.
std::vector<std::string> given_words(const CLI::App& verb, const std::vector<std::string_view>& without);

/// Parses words of given_words(). Throws Error(input) when they do not fit to the options of `verb`, because
/// another version of the program wrote them.
void parse_words(CLI::App& verb, const std::vector<std::string>& words, const std::string& where);

}  // namespace faba::cli
