#pragma once
#include <filesystem>
#include <string>

#include "core/vec.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// Adds the coil system file of a verb.
void add_rig_file(CLI::App* v, std::filesystem::path& rig);

/// Value in m of the text of an option, such as "1 mm". Throws Error(usage, option).
double metres(const std::string& option, const std::string& text);
/// Position in m from a text such as "1 mm, 0 mm". Throws Error(usage, option).
Vec2 position(const std::string& option, const std::string& text);
/// Width and height of --size, m. Throws Error(usage, "--size").
Vec2 rectangle(const std::string& text);

}  // namespace faba::cli
