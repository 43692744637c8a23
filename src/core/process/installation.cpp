#include "core/process/installation.h"

#include <algorithm>
#include <array>
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
  const fs::path self = fs::read_symlink("/proc/self/exe", ec);
  if (ec) throw Error(Errc::internal, "faba", "the folder of this program cannot be read: " + ec.message());
  return self;
}

fs::path program_folder() { return named_folder().empty() ? this_program().parent_path() : named_folder(); }

bool holds_examples(const fs::path& folder) {
  std::error_code ec;
  return fs::is_directory(folder / "scenes", ec) && fs::is_directory(folder / "rigs", ec);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, ec)) names.push_back(e.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
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
  if (named.empty() || named.is_absolute() || fs::exists(named, ec)) return named;
  const fs::path examples = examples_folder();
  if (examples.empty()) return named;
  if (!named.has_parent_path() && !named.has_extension()) {
    const fs::path example = examples / folder / (named.string() + ".toml");
    if (fs::is_regular_file(example, ec)) return example;
    throw Error(
        Errc::usage, named.string(),
        "no file and no example has this name" + suggestion(named.string(), names_in(examples / folder)));
  }
  if (named.parent_path() == folder && fs::is_regular_file(examples / named, ec))
    throw Error(Errc::usage, named.string(),
                "file not found; the example of this name is `" + named.stem().string() +
                    "`, and `faba init` copies all examples into the current folder");
  return named;
}

}  // namespace faba
