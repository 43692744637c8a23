#include "app/files/installed_parts.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/process/installation.h"
#include "vision/files/video_libraries.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

InstalledPart guard() {
  const fs::path file = program_file("faba-coil-guard");
  const bool present = ::access(file.c_str(), X_OK) == 0;
  return {"coil guard", present, true,
          present
              ? file.string()
              : fmt::format("{} is missing or not executable: no coils can be commanded; install Faba again",
                            file.string())};
}

InstalledPart camera_module() {
  const fs::path file = program_file("faba-capture.so");
  if (void* module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
    dlclose(module);
    return {"camera module", true, false, file.string()};
  }
  return {"camera module", false, false,
          fmt::format("cannot be loaded ({}): cameras cannot be opened; install the package faba-camera, "
                      "which is built together with that of faba (`make package`)",
                      dlerror())};
}

InstalledPart ffmpeg() {
  const std::string problem = problem_of_video_libraries();
  return {"FFmpeg", problem.empty(), true,
          problem.empty() ? "its libraries are loaded" : "videos cannot be read or written: " + problem};
}

InstalledPart examples() {
  const fs::path folder = examples_folder();
  return {"examples", !folder.empty(), true,
          folder.empty() ? "no folder with scenes, coil systems and studies: install Faba again"
                         : folder.string()};
}

// The devices of which the name has one of the prefixes, with the group that may open them.
InstalledPart devices(const char* name, std::initializer_list<const char*> prefixes, const char* group,
                      const char* without) {
  std::string open, closed;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator("/dev", ec))
    for (const char* prefix : prefixes)
      if (e.path().filename().string().starts_with(prefix))
        (::access(e.path().c_str(), R_OK | W_OK) == 0 ? open : closed) += " " + e.path().string();
  if (!closed.empty())
    return {name, false, false,
            fmt::format("no permission to open{}; run `sudo usermod -a -G {} $USER` and log in again", closed,
                        group)};
  return {name, !open.empty(), false, open.empty() ? without : open.substr(1)};
}

bool in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

InstalledPart other_program(const char* program, const char* package, const char* purpose) {
  const bool present = in_path(program);
  return {program, present, false,
          present ? purpose : fmt::format("not found; {} (package {})", purpose, package)};
}

InstalledPart current_folder() {
  const bool present = ::access(".", W_OK) == 0;
  return {"current folder", present, false,
          present ? "can be written"
                  : "cannot be written: runs need a folder of yours; use --out, or change folder"};
}

}  // namespace

std::vector<InstalledPart> installed_parts() {
  return {guard(),
          camera_module(),
          ffmpeg(),
          examples(),
          current_folder(),
          devices("serial boards", {"ttyACM", "ttyUSB"}, "dialout",
                  "none connected (/dev/ttyACM*, /dev/ttyUSB*)"),
          devices("cameras", {"video"}, "video", "none connected (/dev/video*)"),
          other_program("xdg-open", "xdg-utils", "opens the page of `faba lab` in a browser"),
          other_program("sbatch", "slurm-client", "studies with --engine slurm"),
          other_program("parallel", "parallel", "studies with --engine parallel")};
}

}  // namespace faba
