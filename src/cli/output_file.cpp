#include "cli/output_file.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba::cli {

void check_output(const std::filesystem::path& file, const char* extension, bool force,
                  const std::vector<std::filesystem::path>& inputs) {
  if (file.empty()) return;
  const auto refuse = [&](const std::string& why) { throw Error(Errc::usage, file.string(), why); };
  std::error_code ec;
  if (std::filesystem::is_directory(file, ec)) refuse("is a directory; name a file");
  if (*extension && file.extension() != extension)
    refuse(fmt::format("must end in {}, which is what is written", extension));
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ec))) return;
  if (std::filesystem::exists(file, ec) && !std::filesystem::is_regular_file(file, ec))
    refuse("is no file that could be replaced; name another one");
  for (const auto& input : inputs)
    if (std::filesystem::equivalent(file, input, ec)) refuse("is what this command reads; name another file");
  if (!force) refuse("already exists; name another file, or --force to replace it");
}

}  // namespace faba::cli
