#include "server/scenarios/gallery_index.h"

#include <doctest/doctest.h>

#include <set>

#include "core/error.h"
#include "core/file.h"
#include "server/workspace.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

TEST_CASE("the index of the gallery gives order, purpose and texts") {
  const test::TemporaryFolder folder("gallery");
  CHECK(read_gallery_index(folder.path()).empty());
  write_file(folder.path() / kGalleryIndex,
             "[[scene]]\nname = 'b'\npurpose = 'step-response'\nsummary = 'One.'\n[[scene]]\nname = 'a'\n");
  const auto cards = read_gallery_index(folder.path());
  REQUIRE(cards.size() == 2);
  CHECK(cards[0].name == "b");
  CHECK(texts(cards[0]) == Json{{"purpose", "step-response"}, {"summary", "One."}});
  CHECK(cards[1].name == "a");
  write_file(folder.path() / kGalleryIndex, "[[scene]]\npurpose = 'fun'\n");
  CHECK_THROWS_WITH_AS(read_gallery_index(folder.path()), doctest::Contains("scene[0].purpose"),
                       const Error&);
}

TEST_CASE("the scenes of the program are listed in its index, once, with a sentence") {
  const fs::path scenes = fs::path(FABA_SCENES);
  std::set<std::string> listed;
  for (const GalleryCard& c : read_gallery_index(scenes)) {
    INFO(c.name);
    CHECK(listed.insert(c.name).second);
    CHECK(fs::exists(scenes / (c.name + ".toml")));
    CHECK_FALSE(c.summary.empty());
    CHECK(c.summary.size() < 150);
  }
  for (const fs::path& scene : Workspace(scenes.parent_path(), {}).scenes()) {
    INFO(scene.string());
    CHECK(listed.contains(scene.stem().string()));
  }
}
