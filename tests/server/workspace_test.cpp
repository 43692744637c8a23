#include "server/workspace.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

TEST_CASE("S6: names outside of the workspace are refused") {
  test::TemporaryFolder folder("workspace");
  const fs::path root = folder.path() / "lab";
  fs::create_directories(root / "runs" / "one");
  fs::create_directories(folder.path() / "lab-beside");
  write_file(folder.path() / "secret.txt", "s");
  write_file(folder.path() / "lab-beside" / "secret.txt", "s");
  write_file(root / "runs" / "one" / "series.csv", "x");
  write_file(root / ".hidden", "s");
  fs::create_symlink(folder.path() / "secret.txt", root / "runs" / "link.txt");
  fs::create_symlink(folder.path(), root / "runs" / "out");
  fs::create_symlink(root / "runs" / "one", root / "runs" / "same");
  const Workspace w(root, {});

  CHECK(w.existing("runs/one/series.csv") == fs::canonical(root / "runs/one/series.csv"));
  CHECK(w.existing("runs/same/series.csv") ==
        fs::canonical(root / "runs/one/series.csv"));  // a link inside the workspace
  for (const std::string& bad :
       {std::string(), std::string("../secret.txt"), std::string("runs/../../secret.txt"),
        std::string("/etc/passwd"), (folder.path() / "secret.txt").string(), std::string("runs/link.txt"),
        std::string("runs/out/secret.txt"), std::string("runs/out"), std::string("../lab-beside/secret.txt"),
        std::string(".hidden"), std::string("runs/.."), std::string("runs/./one"), std::string("a\0b", 3),
        std::string(5000, 'a'), std::string("~/x/../../..")}) {
    INFO(bad.substr(0, 60));
    CHECK_THROWS_AS(w.inside(bad), const Error&);
  }
  CHECK_THROWS_WITH_AS(w.inside("../secret.txt"),
                       doctest::Contains("is outside the folder in which the lab was started"), const Error&);
  CHECK_THROWS_WITH_AS(w.existing("runs/two"),
                       doctest::Contains("not found in the folder in which the lab was started"),
                       const Error&);
  CHECK_NOTHROW(w.inside("runs/two"));
}

TEST_CASE("S6: a scenario of a page cannot refer to files outside of the workspace") {
  test::TemporaryFolder folder("workspace");
  const fs::path root = folder.path() / "lab";
  fs::create_directories(root / "scenes");
  fs::create_directories(root / "rigs");
  write_file(root / "rigs/r.toml", "");
  write_file(folder.path() / "secret.toml", "");
  const Workspace w(root, {});
  const auto field = [](const std::string& file) {
    return Json{{"field", {{"type", "rig"}, {"file", file}}}};
  };
  CHECK_NOTHROW(w.check_files(field("rigs/r.toml")));
  CHECK_NOTHROW(w.check_files(field("../rigs/r.toml")));  // as in the scenes of the gallery
  CHECK_NOTHROW(w.check_files(field((fs::canonical(root) / "rigs/r.toml").string())));
  CHECK_NOTHROW(w.check_files(field("rigs/absent.toml")));  // the loader reports it
  for (const char* bad : {"/etc/passwd", "../secret.toml", "../../secret.toml", "../../../etc/passwd",
                          "/dev/zero", "../rigs", "."}) {
    INFO(bad);
    CHECK_THROWS_AS(w.check_files(field(bad)), const Error&);
    CHECK_THROWS_AS(w.check_files({{"swarm", Json::array({{{"x", {{"file", bad}}}}})}}), const Error&);
    CHECK_THROWS_AS(w.check_files({{"microscope", {{"background", bad}}}}), const Error&);
  }
}

TEST_CASE("scenes and runs of the workspace") {
  test::TemporaryFolder folder("workspace");
  const fs::path root = folder.path();
  for (const char* dir : {"scenes", "runs/a", "runs/drawn", "runs/broken", "runs/empty", "runs/.b"})
    fs::create_directories(root / dir);
  write_file(root / "scenes/b.toml", "");
  write_file(root / "scenes/a.toml", "");
  write_file(root / "scenes/x.txt", "");
  write_file(root / "scenes/gallery.toml", "");  // the index of the gallery is not a scene
  for (const char* run : {"a", "drawn", "broken"}) {
    write_file(root / "runs" / run / "manifest.json", "{");
    write_file(root / "runs" / run / "scenario.toml", "");
  }
  const Workspace w(root, {});
  REQUIRE(w.scenes().size() == 2);
  CHECK(w.scenes()[0].filename() == "a.toml");
  CHECK(w.scene("b") == fs::canonical(root) / "scenes/b.toml");
  for (const char* bad : {"c", "../scenes/b", "x", "", "b.toml"}) CHECK_THROWS_AS(w.scene(bad), const Error&);
  CHECK(w.runs().size() == 3);
}

TEST_CASE("without scenes in the workspace, the gallery of the program is used") {
  test::TemporaryFolder folder("workspace"), program("program");
  write_file(program.path() / "s.toml", "");
  CHECK(Workspace(folder.path(), program.path()).scene("s") == program.path() / "s.toml");
  CHECK(Workspace(folder.path(), folder.path() / "none").scenes().empty());
}

TEST_CASE("S6: allowed folders can be read, and nothing beside them") {
  test::TemporaryFolder folder("allowed");
  const fs::path root = folder.path() / "lab", data = folder.path() / ".data";
  for (const fs::path& dir : {root, data / "sub", folder.path() / "other"}) fs::create_directories(dir);
  for (const fs::path& file :
       {data / "a.avi", data / "sub/b.avi", data / ".hidden.avi", folder.path() / "other/c.avi"})
    write_file(file, "x");
  fs::create_symlink(folder.path() / "other/c.avi", data / "link.avi");
  const Workspace w(root, {}, {data});
  CHECK(w.existing((data / "sub/b.avi").string()) == fs::canonical(data / "sub/b.avi"));
  CHECK(w.name_of(data / "a.avi") == fs::canonical(data / "a.avi").string());
  CHECK(w.name_of(root / "runs/x") == "runs/x");
  CHECK(w.may_read(root));
  for (const fs::path& bad : {data / ".hidden.avi", data / "link.avi", folder.path() / "other/c.avi",
                              data / "../other/c.avi", fs::path("/etc/passwd"), folder.path()}) {
    INFO(bad);
    CHECK(!w.may_read(bad));
    CHECK_THROWS_AS(w.existing(bad.string()), const Error&);
  }
  // Nothing is written there.
  CHECK_THROWS_AS(w.inside((data / "new.toml").string()), const Error&);
  CHECK_THROWS_WITH_AS(Workspace(root, {}, {folder.path() / "missing"}), doctest::Contains("is not a folder"),
                       const Error&);
}

TEST_CASE("S6: pictures are kept in the workspace, and never replace a file") {
  test::TemporaryFolder folder("workspace");
  const fs::path root = folder.path() / "lab";
  fs::create_directories(root / "scenes");
  write_file(folder.path() / "upload", "picture");
  const Workspace w(root, {});
  const auto keep = [&](const char* name) { return w.keep_picture(folder.path() / "upload", name); };
  CHECK(keep("a drop.tif") == "pictures/a drop.tif");
  CHECK(read_file(root / "pictures/a drop.tif") == "picture");
  CHECK(keep("a drop.tif") == "pictures/a drop-2.tif");
  CHECK(keep("../../out.tif") == "pictures/out.tif");
  for (const char* bad : {"..", ".", "", "/", ".hidden.png"}) CHECK_THROWS_AS(keep(bad), const Error&);
  CHECK_FALSE(fs::exists(folder.path() / "out.tif"));
  write_file(root / "b.png", "");
  CHECK(w.pictures() == std::vector<std::string>{"b.png", "pictures/a drop-2.tif", "pictures/a drop.tif",
                                                 "pictures/out.tif"});
  CHECK(w.scenario_file("pictures/out.tif") == fs::canonical(root) / "pictures/out.tif");
  CHECK_THROWS_AS((void)w.scenario_file("../upload"), const Error&);
  // A link in place of the folder or of a picture does not lead out of the workspace.
  fs::create_symlink(folder.path() / "target.png", root / "pictures/link.png");
  CHECK(keep("link.png") == "pictures/link-2.png");
  CHECK_FALSE(fs::exists(folder.path() / "target.png"));
  fs::remove_all(root / "pictures");
  fs::create_directory_symlink(folder.path(), root / "pictures");
  CHECK_THROWS_AS(keep("c.png"), const Error&);
}
