#include "vision/files/picture_metadata.h"

#include <vector>

#include "core/error.h"
#include "vision/files/input_file.h"
#include "vision/files/picture_sequence.h"
#include "vision/files/tiff_stack.h"

namespace faba {

PictureMetadata picture_metadata(const std::filesystem::path& path) {
  try {
    if (is_picture_sequence(path)) {
      const std::vector<std::filesystem::path> pictures = sequence_files(path);
      return pictures.empty() ? PictureMetadata{} : picture_metadata(pictures.front());
    }
    if (check_input_file(path) != InputKind::tiff) return {};
    return TiffStack(path).metadata();
  } catch (const Error&) {  // the reader of the pictures reports it
    return {};
  }
}

}  // namespace faba
