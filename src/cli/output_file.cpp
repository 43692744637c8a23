#include "cli/output_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace faba::cli {

void check_output(const std::filesystem::path& file, const char* extension, bool force,
                  const std::vector<std::filesystem::path>& inputs) {
  if (file.empty()) return;
  const auto refuse = [&](const std::string& why) { throw Error(Errc::usage, file.string(), why); };
  std::error_code ec;
  if (std::filesystem::is_directory(file, ec)) refuse("is a directory; name a file");
  if (const auto folder = file.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder, ec))
    refuse(fmt::format("cannot be written: there is no folder {}", folder.string()));
  if (*extension && file.extension() != extension)
    refuse(fmt::format("must end in {}, which is what is written", extension));
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ec))) return;
  if (std::filesystem::exists(file, ec) && !std::filesystem::is_regular_file(file, ec))
    refuse("is no file that could be replaced; name another one");
  for (const auto& input : inputs)
    if (std::filesystem::equivalent(file, input, ec)) refuse("is what this command reads; name another file");
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& input : inputs)
    if (std::filesystem::is_directory(input, ec) && std::filesystem::equivalent(folder, input, ec))
      refuse("is one of the files that this command reads; name another one");
  if (!force) refuse("already exists; name another file, or --force to replace it");
}

void check_distinct(std::vector<std::filesystem::path> outputs) {
  std::erase_if(outputs, [](const auto& path) { return path.empty(); });
  for (auto& path : outputs) path = std::filesystem::absolute(path).lexically_normal();
  std::sort(outputs.begin(), outputs.end());
  if (const auto twice = std::adjacent_find(outputs.begin(), outputs.end()); twice != outputs.end())
    throw Error(Errc::usage, twice->string(), "is named for two outputs; give each a name of its own");
}

}  // namespace faba::cli
