#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace faba::cli {

/// Checks a file before it is written. Rejects an existing file unless `force` is set; always rejects the
/// inputs of the command (`inputs`: files, and folders with their files), folders, devices, and a file
/// extension that is not one of `extensions` ({".png"}; {} permits any). An empty `file` is accepted. Throws
/// Error(usage, file).
void check_output(const std::filesystem::path& file, const std::vector<std::string>& extensions, bool force,
                  const std::vector<std::filesystem::path>& inputs);

/// Checks a folder before files are written into it: rejects a file, and a name with the extension of a file,
/// such as "figure.svg", unless the folder exists. `option` is named in the message; an empty `folder` is
/// accepted. Throws Error(usage, folder).
void check_output_folder(const std::filesystem::path& folder, const char* option);

/// Rejects outputs of one command that have the same name; empty names are ignored. Throws Error(usage).
void check_distinct(std::vector<std::filesystem::path> outputs);

}  // namespace faba::cli
