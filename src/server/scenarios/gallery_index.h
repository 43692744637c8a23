#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// The file in the folder of the scenes that orders the gallery.
inline constexpr const char* kGalleryIndex = "gallery.toml";

/// What the gallery shows of a scene in addition to its scenario.
struct GalleryCard {
  enum class Purpose { start, steer, step_response, coils, thesis };
  std::string name;  ///< file of the scene without ".toml"
  Purpose purpose = Purpose::start;
  std::string summary;  ///< one sentence
  static Schema<GalleryCard> schema();
};

/// The cards of a gallery in the order of its index; empty without an index. Scenes that are not listed are
/// those of the user. Throws Error(usage) with file, line and key.
std::vector<GalleryCard> read_gallery_index(const std::filesystem::path& gallery);

/// The purpose and the text of a card for the page: `purpose`, `summary`.
Json texts(const GalleryCard& card);

}  // namespace faba
