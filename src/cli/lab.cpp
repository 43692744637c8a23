#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "cli/verbs.h"
#include "core/error.h"
#include "core/toml.h"
#include "server/lab.h"

namespace faba::cli {
namespace {

// Whether there is a screen to show a browser on.
bool has_screen() { return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY"); }

void open_browser(const std::filesystem::path& door) {
  std::string opener = "xdg-open", file = door.string();
  char* argv[] = {opener.data(), file.data(), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_RDWR, 0);
  pid_t pid = 0;
  posix_spawnp(&pid, opener.c_str(), &files, nullptr, argv, environ);  // without one the address is printed
  posix_spawn_file_actions_destroy(&files);
}

}  // namespace

int lab(const LabVerb& v, const Common& c) {
  LabOptions o;
  o.program = std::filesystem::read_symlink("/proc/self/exe");
  o.scenes = o.program.parent_path().parent_path() / "scenes";
  o.scene = v.scene, o.pages = v.pages;
  o.port = static_cast<unsigned short>(v.port);
  o.threads = v.threads;
  o.stop = &stop_requested();
  o.ready = [&](const std::string& address, const std::filesystem::path& door) {
    if (c.json)
      fmt::print("{}\n", Json{{"address", address}}.dump());
    else
      fmt::print("{}\n", address);
    if (!c.json && !c.quiet) fmt::print("The live lab, for this machine only; Ctrl-C ends it.\n");
    if (std::fflush(stdout) != 0) throw Error(Errc::internal, "standard output", "cannot be written");
    if (!v.no_browser && has_screen()) open_browser(door);
  };
  serve_lab(o);
  return 0;
}

}  // namespace faba::cli
