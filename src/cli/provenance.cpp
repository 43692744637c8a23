#include "cli/provenance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "study/pages/provenance_output.h"

namespace faba::cli {
namespace {

// Options of all verbs that do not change the result: outputs, and how it is computed or printed.
constexpr std::array<std::string_view, 25> kWithoutEffect{
    "--help",     "--json",    "--quiet",  "--threads",   "--force",      "--out",     "--report",
    "--picture",  "--overlay", "--swarm",  "--per-track", "--stages",     "--figures", "--preview",
    "--shard",    "--merge",   "--check",  "--engine",    "--engine-set", "--workers", "--scheduler",
    "--sshlogin", "--folder",  "--result", "--format"};

}  // namespace

std::vector<std::pair<std::string, std::string>> options_with_effect(const Common& c) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const CLI::Option* option : c.verb->get_options()) {
    if (option->count() == 0 || option->get_positional()) continue;
    const std::string name = option->get_name();
    if (std::find(kWithoutEffect.begin(), kWithoutEffect.end(), name) != kWithoutEffect.end()) continue;
    const bool flag = option->get_expected_max() == 0;
    options.emplace_back(name, flag ? "" : fmt::format("{}", fmt::join(option->results(), " ")));
  }
  return options;
}

Provenance provenance_of(const Common& c, const std::vector<std::filesystem::path>& inputs) {
  Provenance p;
  for (const auto& input : inputs) p.add(input);
  p.options = options_with_effect(c);
  return p;
}

void print_json(nlohmann::ordered_json result, const Provenance& p) {
  add_provenance(result, p);
  fmt::print("{}\n", result.dump());
}

}  // namespace faba::cli
