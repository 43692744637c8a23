#include "vision/files/picture_metadata.h"

#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/table.h"
#include "vision/files/frame_interval.h"
#include "vision/files/input_file.h"
#include "vision/files/picture_sequence.h"
#include "vision/files/tiff/tiff_stack.h"

namespace faba {

namespace {

// Pictures per second in the table of times of a captured folder; 0: no such table.
double captured_rate(const std::filesystem::path& folder) try {
  const std::filesystem::path file = folder / "times.csv";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return 0;
  const Table times = read_table(file, LastLine::drop);
  const auto t = times.find("t_s");
  const auto interval = times.has("camera_frame") ? frame_interval(t) : std::nullopt;
  return interval ? 1 / interval->s : 0;
} catch (const Error&) {  // a table of another program
  return 0;
}

}  // namespace

PictureMetadata picture_metadata(const std::filesystem::path& path) {
  try {
    if (is_picture_sequence(path)) {
      const std::vector<std::filesystem::path> pictures = sequence_files(path);
      if (pictures.empty()) return {};
      PictureMetadata stated = picture_metadata(pictures.front());
      if (!(stated.fps > 0)) stated.fps = captured_rate(path);
      return stated;
    }
    if (check_input_file(path) != InputKind::tiff) return {};
    return TiffStack(path).metadata();
  } catch (const Error&) {  // the reader of the pictures reports it
    return {};
  }
}

}  // namespace faba
