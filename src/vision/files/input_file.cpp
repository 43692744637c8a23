#include "vision/files/input_file.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/error.h"

namespace faba {

InputKind check_input_file(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) { throw Error(Errc::input, path.string(), why); };
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (status.type() == std::filesystem::file_type::not_found) refuse("file not found; check the name");
  if (failure) refuse("cannot be read: " + failure.message());
  if (is_directory(status)) refuse("is a directory; specify one picture or video file");
  if (!is_regular_file(status)) refuse("is not a regular file; save the picture or video to a file first");

  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse("cannot be opened: " + std::generic_category().message(errno));
  std::array<char, 4> head{};
  file.read(head.data(), head.size());
  if (file.gcount() == 0) refuse("the file is empty; the recording or copy is incomplete");
  const std::string_view magic(head.data(), head.size());
  using namespace std::string_view_literals;
  for (const auto tiff : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (magic == tiff) return InputKind::tiff;
  }
  return InputKind::stream;
}

}  // namespace faba
