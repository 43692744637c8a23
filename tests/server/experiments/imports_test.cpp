#include "server/experiments/imports.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

// A picture of 2 x 2 px is the smallest video.
const std::string kPicture = "P5\n2 2\n255\nabcd";

struct Lab {
  test::TemporaryFolder folder{"imports"};
  Workspace workspace{folder.path(), {}, {}};
  ExperimentStore store{workspace, [](const std::string&) {}};
  Imports imports{store};
  fs::path videos = folder.path() / "experiments/x/videos";

  Lab() { store.create("x"); }
  Json take(const std::string& name, std::uint64_t offset, const std::string& bytes,
            std::uint64_t size = kPicture.size()) {
    return imports.take("x", {.name = name, .size = size, .offset = offset, .modified_s = 1700000000}, bytes);
  }
};

}  // namespace

TEST_CASE("a file that comes in parts becomes a video of the experiment") {
  Lab lab;
  CHECK(lab.take("a.pgm", 0, kPicture.substr(0, 5)) == Json{{"received", 5}});
  CHECK(lab.imports.received("x", "a.pgm", kPicture.size()) == 5);
  CHECK(lab.imports.incomplete("x") ==
        Json::array({{{"name", "a.pgm"}, {"size", kPicture.size()}, {"received", 5}}}));
  CHECK(!lab.store.read("x")["experiment"].contains("video"));
  // Another lab continues.
  Imports later(lab.store);
  const Json done = later.take(
      "x", {.name = "a.pgm", .size = kPicture.size(), .offset = 5, .modified_s = 1700000000, .drop = ""},
      kPicture.substr(5));
  CHECK(done["file"] == "videos/a.pgm");
  CHECK(read_file(lab.videos / "a.pgm") == kPicture);
  CHECK(lab.store.read("x")["experiment"]["video"][0]["file"] == "videos/a.pgm");
  CHECK(later.incomplete("x").empty());
  const auto time = fs::file_time_type::clock::to_sys(fs::last_write_time(lab.videos / "a.pgm"));
  CHECK(std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count() == 1700000000);
  // The same name again does not replace the file.
  CHECK(lab.take("a.pgm", 0, kPicture)["file"] == "videos/a-2.pgm");
}

TEST_CASE("a part that does not follow the bytes received is refused") {
  Lab lab;
  lab.take("a.pgm", 0, kPicture.substr(0, 5));
  CHECK_THROWS_WITH_AS(lab.take("a.pgm", 0, kPicture.substr(0, 5)),
                       doctest::Contains("number of bytes received, 5"), const Error&);
  CHECK_THROWS_AS(lab.take("a.pgm", 9, "x"), const Error&);
  CHECK_THROWS_AS(lab.take("a.pgm", 5, std::string(100, 'x')), const Error&);  // longer than stated
  lab.imports.cancel("x", "a.pgm", kPicture.size());
  CHECK(fs::is_empty(lab.videos));
  CHECK_NOTHROW(lab.imports.cancel("x", "a.pgm", kPicture.size()));
}

TEST_CASE("a file without frames is refused and removed") {
  Lab lab;
  CHECK_THROWS_WITH_AS(lab.take("notes.txt", 0, "hello", 5), doctest::Contains("notes.txt"), const Error&);
  CHECK(fs::is_empty(lab.videos));
  CHECK(!lab.store.read("x")["experiment"].contains("video"));
  CHECK_THROWS_WITH_AS(lab.take("a.pgm", 0, "", 0), doctest::Contains("empty"), const Error&);
}

TEST_CASE("a file that does not fit on the disk is refused before the first byte") {
  Lab lab;
  CHECK_THROWS_WITH_AS(lab.take("big.avi", 0, "x", std::uint64_t(1) << 60), doctest::Contains("MB are free"),
                       const Error&);
  CHECK(fs::is_empty(lab.videos));
  // Neither is one whose size is near the limit of the number.
  for (const std::uint64_t size :
       {~std::uint64_t(0), ~std::uint64_t(0) - (100u << 20), std::uint64_t(1) << 63})
    CHECK_THROWS_WITH_AS(lab.take("big.avi", 0, "x", size), doctest::Contains("MB are free"), const Error&);
  CHECK(fs::is_empty(lab.videos));
}

TEST_CASE("the time of a file is limited, and so is the number of incomplete uploads") {
  Lab lab;
  for (const std::int64_t time :
       {std::numeric_limits<std::int64_t>::max(), std::int64_t(-1), std::int64_t(1) << 40})
    CHECK_THROWS_AS(
        lab.imports.take("x", {.name = "a.pgm", .size = kPicture.size(), .modified_s = time}, kPicture),
        const Error&);
  CHECK(fs::is_empty(lab.videos));
  for (int k = 0; k < 200; ++k) lab.take(std::to_string(k) + ".pgm", 0, "P5");
  CHECK_THROWS_WITH_AS(lab.take("more.pgm", 0, "P5"), doctest::Contains("200 uploads"), const Error&);
  CHECK(lab.take("7.pgm", 2, kPicture.substr(2))["file"] == "videos/7.pgm");
  CHECK_NOTHROW(lab.take("more.pgm", 0, "P5"));
}

TEST_CASE("S6: uploads cannot leave the folder of the experiment") {
  Lab lab;
  test::TemporaryFolder other("elsewhere");
  CHECK(lab.take("../../../evil.pgm", 0, kPicture)["file"] == "videos/evil.pgm");
  CHECK(lab.take(".hidden.pgm", 0, kPicture)["file"] == "videos/hidden.pgm");
  // A link at the place of the incomplete file is not followed.
  const std::string partial = "." + std::to_string(kPicture.size()) + "-b.pgm.part";
  fs::create_symlink(other.path() / "target", lab.videos / partial);
  CHECK_THROWS_AS(lab.take("b.pgm", 0, kPicture), const Error&);
  CHECK(!fs::exists(other.path() / "target"));
  CHECK_THROWS_AS(lab.imports.take("../x", {.name = "a.pgm", .size = 4}, "abcd"), const Error&);
}

TEST_CASE("the drop of a video may have been removed during its upload") {
  Lab lab;
  lab.imports.take("x", {.name = "a.pgm", .size = kPicture.size(), .drop = "A"}, kPicture);
  CHECK(lab.store.read("x")["experiment"]["video"] == Json::array({{{"file", "videos/a.pgm"}}}));
}
