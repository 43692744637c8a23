#pragma once
#include <string>

namespace faba {

/// Version and sources of the program, "0.2.0+1a2b3c4d": the digits are those of a hash of all source files.
/// Parts of a study are combined only when this text is equal, because two programs of one version can
/// differ in their results. The build generates the definition (tools/program_version.cmake).
std::string program_version();

}  // namespace faba
