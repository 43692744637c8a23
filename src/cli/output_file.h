#pragma once
#include <filesystem>
#include <vector>

namespace faba::cli {

/// Before a file is written: refuses one that exists unless `force` is set, and in any case what the command
/// reads (`inputs`: files, and folders with what is in them), folders and devices, and another ending than
/// `extension` (".png"; "" takes any). An empty `file` is not written and passes. Throws Error(usage, file).
void check_output(const std::filesystem::path& file, const char* extension, bool force,
                  const std::vector<std::filesystem::path>& inputs);

/// Refuses outputs of one command that have the same name; empty ones do not count. Throws Error(usage).
void check_distinct(std::vector<std::filesystem::path> outputs);

}  // namespace faba::cli
