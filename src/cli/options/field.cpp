#include "cli/options/field.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/quantity.h"
#include "core/error.h"

namespace faba::cli {

void add_rig_file(CLI::App* v, std::filesystem::path& rig) {
  v->add_option("rig", rig, "Coil system file (TOML), or an example such as helmholtz")
      ->required()
      ->transform(or_example("rigs"));
}

double metres(const std::string& option, const std::string& text) {
  return quantity_of(text, "m", option, "1 mm");
}

Vec2 position(const std::string& option, const std::string& text) {
  const char* example = option == "--at" ? "1 mm, -0.5 mm" : "6 mm, 4.5 mm";
  const auto comma = text.find(',');
  if (comma == std::string::npos)
    throw Error(Errc::usage, option,
                fmt::format("\"{}\" is one value; two lengths are required, such as \"{}\"", text, example));
  const Vec2 at{quantity_of(text.substr(0, comma), "m", option, example),
                quantity_of(text.substr(std::min(comma + 1, text.size())), "m", option, example)};
  if (!(std::fabs(at.x) <= 1 && std::fabs(at.y) <= 1))
    throw Error(Errc::usage, option,
                fmt::format("\"{}\" is out of range; both lengths must be between -1 m and 1 m", text));
  return at;
}

Vec2 rectangle(const std::string& text) {
  const Vec2 size = position("--size", text);
  if (!(size.x > 0 && size.y > 0 && size.x <= 1 && size.y <= 1))
    throw Error(Errc::usage, "--size",
                fmt::format("\"{}\" is out of range; width and height must be positive and at most 1 m, such "
                            "as \"6 mm, 4.5 mm\"",
                            text));
  return size;
}

}  // namespace faba::cli
