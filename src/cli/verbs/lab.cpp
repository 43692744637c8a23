#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "cli/command_line.h"
#include "core/error.h"
#include "core/process/installation.h"
#include "core/toml.h"
#include "server/lab.h"

namespace faba::cli {
namespace {

struct LabVerb {
  std::filesystem::path scene, pages;
  std::vector<std::filesystem::path> allowed;
  int port = 0;
  unsigned threads = 0;
  bool no_browser = false;
};

// Whether there is a display for a browser.
bool has_display() { return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY"); }

void open_browser(const std::filesystem::path& door) {
  std::string opener = "xdg-open", file = door.string();
  char* argv[] = {opener.data(), file.data(), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_RDWR, 0);
  pid_t pid = 0;
  posix_spawnp(&pid, opener.c_str(), &files, nullptr, argv,
               environ);  // if this fails, the printed address can be used
  posix_spawn_file_actions_destroy(&files);
}

int lab(const LabVerb& v, const Common& c) {
  LabOptions o;
  o.program = program_file("faba");
  o.scenes = examples_folder() / "scenes";
  o.scene = v.scene;
  o.pages = v.pages;
  o.allowed = v.allowed;
  o.port = static_cast<unsigned short>(v.port);
  o.threads = v.threads;
  o.stop = &stop_requested();
  o.ready = [&](const std::string& address, const std::filesystem::path& door) {
    if (c.json)
      fmt::print("{}\n", Json{{"address", address}}.dump());
    else
      fmt::print("{}\n", address);
    if (!c.quiet && ::access(".", W_OK) != 0)
      print_stderr(
          "faba: note: the current folder cannot be written: nothing can be recorded or saved; start the lab "
          "in another folder");
    if (!c.json && !c.quiet)
      fmt::print("The live lab is running, for this machine only; press Ctrl-C to stop it.\n");
    if (std::fflush(stdout) != 0) throw Error(Errc::internal, "standard output", "cannot be written");
    if (!v.no_browser && has_display()) open_browser(door);
  };
  serve_lab(o);
  return 0;
}

}  // namespace

void add_lab(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<LabVerb>();
  CLI::App* v = verb(app, line, "lab", "Start the live lab: watch, steer and record a swarm in a browser",
                     "  faba lab\n  faba lab scenes/steer.toml\n  faba lab --no-browser --port 8765");
  v->add_option("scene", o->scene,
                "Scenario file to open, or an example such as steer; default: the page shows the gallery")
      ->transform(or_example("scenes"));
  v->add_option("--port", o->port, "Port on 127.0.0.1; default: any free port")->check(integers(0, 65535));
  v->add_option(
       "--allow", o->allowed,
       "Folder from which the page may read videos and pictures, outside the folder in which the lab is "
       "started; may be repeated")
      ->check(not_empty);
  v->add_flag("--no-browser", o->no_browser, "Do not open a browser; print the address only");
  v->add_option(
       "--threads", o->threads,
       "Number of threads; default: all threads of the machine but one, which is left to the browser")
      ->check(integers(1, 1024));
  v->add_option("--www", o->pages, "Read the files of the page from this folder, for development")
      ->check([](const std::string& path) {
        return std::filesystem::is_directory(path) ? "" : fmt::format("folder {} not found", path);
      });
  v->callback([o, &line] { line.code = lab(*o, line.common); });
}

}  // namespace faba::cli
