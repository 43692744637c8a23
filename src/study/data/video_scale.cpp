#include "study/data/video_scale.h"

#include "vision/files/picture_metadata.h"

namespace faba {

VideoScale scale_of_file(const std::filesystem::path& file) {
  const PictureMetadata stated = picture_metadata(file);
  return {stated.um_per_px, stated.um_per_px ? "metadata" : "", stated.ignored};
}

}  // namespace faba
