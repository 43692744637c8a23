#include "core/process/installation.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/schema.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

fs::path& named_folder() {
  static fs::path path;  // empty: that of this program
  return path;
}

fs::path this_program() {
  std::error_code ec;
  fs::path self = fs::read_symlink("/proc/self/exe", ec);
  if (ec) throw Error(Errc::internal, "faba", "the folder of this program cannot be read: " + ec.message());
  return self;
}

fs::path program_folder() { return named_folder().empty() ? this_program().parent_path() : named_folder(); }

bool holds_examples(const fs::path& folder) {
  std::error_code ec;
  return fs::is_directory(folder / "scenes", ec) && fs::is_directory(folder / "rigs", ec);
}

std::string advice_for_name(const fs::path& missing) {
  const fs::path examples = examples_folder();
  if (examples.empty() || missing.is_absolute()) return {};
  std::error_code ec;
  if (missing.has_parent_path())
    return fs::is_regular_file(examples / missing, ec)
               ? "; the example of this name is `" + missing.stem().string() +
                     "`, and `faba init` copies all examples into the current folder"
               : "";
  if (missing.has_extension()) return "";
  std::vector<std::string> names;
  for (const auto& [folder, content] :
       {std::pair{"scenes", "a scenario"}, {"rigs", "a coil system"}, {"studies", "a study"}}) {
    for (const auto& e : fs::directory_iterator(examples / folder, ec))
      names.push_back(e.path().stem().string());
    if (std::find(names.begin(), names.end(), missing.string()) != names.end())
      return std::string("; the example of this name is ") + content + ", which this command does not take";
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return "; no example has this name" + suggestion(missing.string(), names);
}

}  // namespace

fs::path program_file(const std::string& name) {
  // A copy of the program with another name starts itself, and no other build in its folder.
  if (name == "faba" && named_folder().empty()) return this_program();
  const fs::path beside = program_folder() / name;
  const fs::path installed = program_folder().parent_path() / "libexec" / "faba" / name;
  std::error_code ec;
  return !fs::exists(beside, ec) && fs::exists(installed.parent_path(), ec) ? installed : beside;
}

void set_program_folder(const fs::path& path) { named_folder() = path; }

fs::path examples_folder() {
  const fs::path bin = program_folder();
  // A build directory is in the source tree, that of a preset one folder deeper.
  const std::array candidates{bin.parent_path() / "share" / "faba", bin.parent_path(),
                              bin.parent_path().parent_path()};
  for (const fs::path& candidate : candidates)
    if (holds_examples(candidate)) return candidate;
  return {};
}

fs::path file_or_example(const fs::path& named, const std::string& folder) {
  std::error_code ec;
  if (named.empty() || named.has_parent_path() || named.has_extension() || fs::exists(named, ec))
    return named;
  const fs::path example = examples_folder() / folder / (named.string() + ".toml");
  return fs::is_regular_file(example, ec) ? example : named;
}

std::string example_advice(const Error& e) {
  if (e.reason() == "file not found; check the name") return advice_for_name(e.where());  // of read_toml()
  if (!e.reason().starts_with("file not found: ")) return "";
  const fs::path examples = examples_folder();
  const bool of_example = !examples.empty() && e.where().starts_with((examples / "studies" / "").string());
  return of_example
             ? "; record it first: the comment at the top of the study states the command. In an installed "
               "Faba, do both in a folder that `faba init` has made"
             : "";
}

}  // namespace faba
