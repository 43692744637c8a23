#pragma once
#include <filesystem>

#include "core/toml.h"
#include "server/web_handlers.h"

namespace faba {

WebResponse json_answer(const Json& j);
/// A file with the content type of its extension.
WebResponse file_answer(const std::filesystem::path& file);
/// A file of the user or an output of the program: it runs no script, see WebResponse.
WebResponse output_answer(const std::filesystem::path& file);
/// A picture that the lab has rendered under a name that changes with its content.
WebResponse picture_answer(const std::filesystem::path& file);
/// Content type of a file name.
const char* content_type(const std::filesystem::path& file);

}  // namespace faba
