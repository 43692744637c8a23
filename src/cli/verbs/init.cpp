#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include "cli/command_line.h"
#include "core/error.h"
#include "core/file.h"
#include "core/process/installation.h"
#include "core/toml.h"

namespace faba::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array kExampleFolders{"scenes", "rigs", "studies", "notebooks"};

struct InitVerb {
  fs::path folder = ".";
  bool force = false;
};

// The files of the examples below their folder, in the order of their names.
std::map<fs::path, fs::path> example_files(const fs::path& examples) {
  std::map<fs::path, fs::path> files;
  for (const char* folder : kExampleFolders) {
    std::error_code ec;
    for (const auto& e : fs::directory_iterator(examples / folder, ec))
      if (e.is_regular_file(ec)) files[fs::path(folder) / e.path().filename()] = e.path();
  }
  return files;
}

// Throws before the first file is written if a file of the user would be replaced.
void reject_changed_files(const std::map<fs::path, fs::path>& files, const fs::path& folder) {
  for (const auto& [name, from] : files) {
    std::error_code ec;
    const fs::path to = folder / name;
    if (fs::exists(to, ec) && (!fs::is_regular_file(to, ec) || read_file(to) != read_file(from)))
      throw Error(Errc::usage, to.string(),
                  "exists and differs from the example; choose another folder, or replace it with --force");
  }
}

int init(const InitVerb& v, const Common& c) {
  const fs::path examples = examples_folder();
  if (examples.empty())
    throw Error(
        Errc::internal, "examples",
        "not found beside this program; install Faba again, or copy the folders scenes, rigs and studies "
        "of its source");
  const auto files = example_files(examples);
  if (!v.force) reject_changed_files(files, v.folder);
  for (const char* folder : kExampleFolders) {
    std::error_code ec;
    fs::create_directories(v.folder / folder, ec);
    if (ec)
      throw Error(Errc::internal, (v.folder / folder).string(), "cannot create this folder: " + ec.message());
  }
  for (const auto& [name, from] : files) write_file(v.folder / name, read_file(from));
  if (c.json) {
    fmt::print("{}\n", Json{{"folder", v.folder.string()}, {"files", files.size()}}.dump());
  } else if (!c.quiet) {
    const std::string there = v.folder == "." ? "" : fmt::format("cd {} && ", v.folder.string());
    fmt::print(
        "{} examples in scenes/, rigs/, studies/ and notebooks/ of {}\nnext: {}faba run scenes/steer.toml\n",
        files.size(), v.folder == "." ? "the current folder" : v.folder.string(), there);
  }
  return 0;
}

}  // namespace

void add_init(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<InitVerb>();
  CLI::App* v =
      verb(app, line, "init", "Copy the examples into a folder: scenes, coil systems, studies and notebooks",
           "  faba init\n  faba init first-steps");
  v->add_option("folder", o->folder, "Folder of the copies; default: the current folder")->check(not_empty);
  v->add_flag("--force", o->force, "Replace files that differ from the examples");
  v->callback([o, &line] { line.code = init(*o, line.common); });
}

}  // namespace faba::cli
