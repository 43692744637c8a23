#include "server/scenarios/gallery_index.h"

#include "core/toml.h"

namespace faba {
namespace {

struct Index {
  std::vector<GalleryCard> scene;
};

Schema<Index> index_schema() {
  return Schema<Index>("gallery", "Order and texts of the gallery")
      .add("scene", &Index::scene, {.doc = "The scenes, in the order of the gallery"});
}

}  // namespace

Schema<GalleryCard> GalleryCard::schema() {
  using C = GalleryCard;
  return Schema<C>("scene", "A scene of the gallery")
      .add("name", &C::name, {.doc = "File of the scene without .toml"})
      .add("purpose", &C::purpose,
           {.doc = "Section of the gallery",
            .choices = {"start", "steer", "step-response", "coils", "thesis"}})
      .add("summary", &C::summary, {.doc = "One sentence"});
}

std::vector<GalleryCard> read_gallery_index(const std::filesystem::path& gallery) {
  const std::filesystem::path file = gallery / kGalleryIndex;
  if (!std::filesystem::exists(file)) return {};
  const Document d = read_toml(file);
  return index_schema().parse(Node(d)).scene;
}

Json texts(const GalleryCard& card) {
  Json all = GalleryCard::schema().to_json(card);
  all.erase("name");
  return all;
}

}  // namespace faba
