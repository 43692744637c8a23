#pragma once
#include <filesystem>
#include <string>

#include "core/error.h"

namespace faba {

/// Path of one of Faba's programs and modules: "faba", "faba-coil-guard", "faba-capture.so". In a build
/// directory they are in one folder, that of this program, unless set_program_folder() names another; under
/// an installation prefix the last two are in libexec/faba. "faba" is this program, whatever its file is
/// named. Throws Error(internal).
std::filesystem::path program_file(const std::string& name);

/// For a process that is not one of them, such as a Python interpreter. To be called before other threads
/// are started.
void set_program_folder(const std::filesystem::path& folder);

/// The folder that holds the examples, scenes/, rigs/ and studies/: PREFIX/share/faba, or the root of the
/// source tree. Empty if neither has them.
std::filesystem::path examples_folder();

/// The file that a user names on a command line. The name of an example, without folder and extension, is
/// that example: "steer" with the folder "scenes" is scenes/steer.toml of examples_folder(), unless there is
/// a file "steer".
std::filesystem::path file_or_example(const std::filesystem::path& named, const std::string& folder);

/// Advice to be added to the message of an error: a file that was not found may be an example that was named
/// in another way, or the video that a study of the examples needs. Empty for other errors.
std::string example_advice(const Error& e);

}  // namespace faba
