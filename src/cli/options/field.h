#pragma once
#include <filesystem>
#include <string>

#include "core/vec.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// The rig file of a verb.
void add_rig_file(CLI::App* v, std::filesystem::path& rig);

/// The value in m of an option's words such as "1 mm". Throws Error(usage, option).
double metres(const std::string& option, const std::string& words);
/// "1 mm, 0 mm" as metres. Throws Error(usage, option).
Vec2 place(const std::string& option, const std::string& words);
/// Width and height of --size, m. Throws Error(usage, "--size").
Vec2 rectangle(const std::string& words);

}  // namespace faba::cli
