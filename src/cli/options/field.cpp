#include "cli/options/field.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/quantity.h"
#include "core/error.h"

namespace faba::cli {

void add_rig_file(CLI::App* v, std::filesystem::path& rig) {
  v->add_option("rig", rig, "Rig file (TOML)")->required();
}

double metres(const std::string& option, const std::string& words) {
  return quantity_of(words, "m", option, "1 mm, -0.5 mm");
}

Vec2 place(const std::string& option, const std::string& words) {
  const auto comma = words.find(',');
  if (comma == std::string::npos)
    throw Error(Errc::usage, option,
                fmt::format("needs two lengths, such as \"1 mm, -0.5 mm\"; \"{}\" is one", words));
  const Vec2 at{metres(option, words.substr(0, comma)),
                metres(option, words.substr(std::min(comma + 1, words.size())))};
  if (!(std::fabs(at.x) <= 1 && std::fabs(at.y) <= 1))
    throw Error(Errc::usage, option, fmt::format("\"{}\" must be two lengths of up to 1 m", words));
  return at;
}

Vec2 rectangle(const std::string& words) {
  const Vec2 size = place("--size", words);
  if (!(size.x > 0 && size.y > 0 && size.x <= 1 && size.y <= 1))
    throw Error(Errc::usage, "--size", "must be two lengths of up to 1 m, such as \"6 mm, 4.5 mm\"");
  return size;
}

}  // namespace faba::cli
