#pragma once
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace faba::cli {

/// Message for an error that CLI11 found in the command line of `command`, such as "faba field map": the
/// unknown option with a suggestion, the missing argument with the usage, the value with its range.
std::string usage_message(const CLI::App& app, const std::string& command, const CLI::ParseError& error);

}  // namespace faba::cli
