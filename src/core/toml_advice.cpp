#include "core/toml_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace faba {
namespace {

bool has(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

bool has_control_character(std::string_view line) {
  return std::any_of(line.begin(), line.end(),
                     [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\r'; });
}

// What a missing bracket, brace or quote means; empty for other errors. `line`: the text of the line.
std::string missing_end(std::string_view reason, std::string_view line) {
  const bool at_end =
      reason.ends_with("saw '\\n'") || reason.ends_with("saw '\\r'") || has(reason, "end-of-file");
  if (has(reason, "table header") && at_end) {
    const auto name = line.find_first_not_of("[ \t");
    if (name == line.npos) return "a closing bracket is missing: write [name]";
    const std::string_view word = line.substr(name, line.find_first_of("] \t\r#", name) - name);
    return fmt::format("a closing bracket is missing: write {}", line.find("[[") == line.npos
                                                                     ? fmt::format("[{}]", word)
                                                                     : fmt::format("[[{}]]", word));
  }
  if (has(reason, "parsing inline table") && at_end)
    return "a closing } is missing, or the table is longer than one line";
  const bool in_string = has(reason, "parsing string") || has(reason, "parsing literal string");
  const bool at_line_end = has(reason, "control characters other than TAB") && !has_control_character(line);
  if (in_string && (at_line_end || has(reason, "end-of-file"))) {
    const char quote = has(reason, "literal") ? '\'' : '"';
    const std::string three(3, quote);
    return fmt::format("the text is not closed; add a quote ({}) at its end",
                       has(line, three) ? three : std::string(1, quote));
  }
  return "";
}

// Advice for frequent errors; empty for others.
std::string advice_on(std::string_view reason) {
  static constexpr const char* kTomlLine =
      "check that this is a TOML file: its lines are KEY = VALUE, [table] or # comment";
  static constexpr const char* kQuotes = "text and quantities with a unit need quotes, such as \"60 Hz\"";
  static constexpr std::pair<std::string_view, std::string_view> kAdvice[] = {
      {"whitespace, saw ','", "write decimals with a point (5.5) and lists in [ ]"},
      {"expected value, saw '\\n'", "write a value after ="},
      {"expected value, saw '\\r'", "write a value after ="},
      {"expected '=', saw", kTomlLine},
      {"expected keys, tables", kTomlLine},
      {"could not determine value type", kQuotes},
      {"expected a comment or whitespace", kQuotes},
      {"cannot redefine existing", "remove one of the two"},
      {"invalid utf-8", "the file is not UTF-8; save it as UTF-8"}};
  for (const auto& [part, advice] : kAdvice)
    if (has(reason, part)) return std::string(advice);
  const bool in_list = has(reason, "expected comma or closing ']', saw '");
  const bool letter =
      in_list && reason.size() > 1 && std::isalpha(static_cast<unsigned char>(reason[reason.size() - 2]));
  return letter ? "put quantities in quotes, such as [\"18 uT\", \"0 uT\"]" : "";
}

}  // namespace

std::string toml_advice(std::string_view reason, std::string_view line) {
  if (std::string text = missing_end(reason, line); !text.empty()) return text;
  std::string advice = advice_on(reason);
  // These beginnings of the parser name no cause.
  for (const std::string_view start :
       {"Error while parsing key-value pair: ", "Error while parsing table header: "})
    if (reason.starts_with(start)) reason.remove_prefix(start.size());
  return advice.empty() ? std::string(reason) : fmt::format("{}; {}", reason, advice);
}

}  // namespace faba
