#pragma once
#include <string>
#include <vector>

namespace faba {

/// Something that the program needs for some of its tasks, on this machine.
struct InstalledPart {
  std::string name;
  bool present = false;
  bool required = false;  ///< without it the installation is incomplete
  std::string note;       ///< where it is; if it is missing, what does not work and what to do
};

/// Guard, camera module, FFmpeg, examples, serial boards, cameras, and programs of other projects.
std::vector<InstalledPart> installed_parts();

}  // namespace faba
