#pragma once
#include <filesystem>
#include <vector>

namespace faba::cli {

/// Checks a file before it is written. Rejects an existing file unless `force` is set; always rejects the
/// inputs of the command (`inputs`: files, and folders with their files), folders, devices, and a file
/// extension other than `extension` (".png"; "" permits any). An empty `file` is accepted. Throws
/// Error(usage, file).
void check_output(const std::filesystem::path& file, const char* extension, bool force,
                  const std::vector<std::filesystem::path>& inputs);

/// Rejects outputs of one command that have the same name; empty names are ignored. Throws Error(usage).
void check_distinct(std::vector<std::filesystem::path> outputs);

}  // namespace faba::cli
