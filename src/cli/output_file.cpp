#include "cli/output_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"

namespace faba::cli {

void check_output(const std::filesystem::path& file, const std::vector<std::string>& extensions, bool force,
                  const std::vector<std::filesystem::path>& inputs) {
  if (file.empty()) return;
  const auto reject = [&](const std::string& reason) { throw Error(Errc::usage, file.string(), reason); };
  std::error_code ec;
  if (std::filesystem::is_directory(file, ec)) reject("is a directory; give a file name");
  if (const auto folder = file.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder, ec))
    reject(fmt::format("cannot be written: folder {} not found", folder.string()));
  const bool exists = std::filesystem::exists(std::filesystem::symlink_status(file, ec));
  if (std::filesystem::exists(file, ec) && !std::filesystem::is_regular_file(file, ec))
    reject("is not a regular file; give another name");
  for (const auto& input : inputs)
    if (std::filesystem::equivalent(file, input, ec))
      reject("is an input of this command; give another name");
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& input : inputs)
    if (exists && std::filesystem::is_directory(input, ec) && std::filesystem::equivalent(folder, input, ec))
      reject("is in a folder that this command reads; give another name");
  const std::string extension = file.extension().string();
  if (!extensions.empty() && std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    reject(fmt::format("the file extension must be {}, not \"{}\"; change the name",
                       fmt::join(extensions, " or "), extension));
  if (exists && !force) reject("already exists; give another name, or --force to replace it");
}

void check_output_folder(const std::filesystem::path& folder, const char* option) {
  std::error_code ec;
  if (folder.empty() || std::filesystem::is_directory(folder, ec)) return;
  if (std::filesystem::exists(folder, ec))
    throw Error(Errc::usage, folder.string(), fmt::format("is a file; {} must be a folder", option));
  static const std::vector<std::string> kFiles = {".svg", ".png", ".jpg",  ".jpeg", ".tif", ".tiff",
                                                  ".pdf", ".csv", ".html", ".h5",   ".mp4", ".avi"};
  const std::string extension = folder.extension().string();
  if (std::find(kFiles.begin(), kFiles.end(), extension) != kFiles.end())
    throw Error(
        Errc::usage, folder.string(),
        fmt::format("is the name of a file; {} must be a folder, into which several files are written; give "
                    "a name without \"{}\"",
                    option, extension));
}

void check_distinct(std::vector<std::filesystem::path> outputs) {
  std::erase_if(outputs, [](const auto& path) { return path.empty(); });
  for (auto& path : outputs) path = std::filesystem::absolute(path).lexically_normal();
  std::sort(outputs.begin(), outputs.end());
  if (const auto twice = std::adjacent_find(outputs.begin(), outputs.end()); twice != outputs.end())
    throw Error(Errc::usage, twice->string(), "is given for two outputs; give them different names");
}

}  // namespace faba::cli
