#include "server/jobs/input_files.h"

#include <doctest/doctest.h>

#include <set>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

TEST_CASE("the files of a workspace by kind; hidden files, links and drawings are not listed") {
  test::TemporaryFolder folder("inputs");
  const fs::path root = folder.path();
  for (const char* dir : {"scenes", "studies", "rigs", "videos/sub", "runs/a", "runs/drawn", "runs/broken",
                          ".git", "experiments/one/videos"})
    fs::create_directories(root / dir);
  for (const auto& [run, manifest] :
       {std::pair{"a", R"({"version": "1", "video_shows": "camera"})"},
        std::pair{"drawn", R"({"version": "1", "video_shows": "drawing"})"}, std::pair{"broken", "{"}}) {
    write_file(root / "runs" / run / "manifest.json", manifest);
    write_file(root / "runs" / run / "video.mp4", "");
  }
  for (const char* file : {"videos/v.mp4", "videos/sub/W.AVI", "ruler.png", "frame.tif", "readings.csv",
                           ".git/x.mp4", "studies/broken.toml", "x.unknown", "experiments/one/videos/e.mp4"})
    write_file(root / file, "[[");
  fs::create_symlink("/etc", root / "videos/link");
  fs::create_symlink("/etc/passwd", root / "videos/link.mp4");
  write_file(root / "rigs/pair.toml", "[[coil]]\ncurrent = '1 A'\n[[coil]]\n");
  write_file(root / "scenes/s.toml", "[[swarm]]\n");
  write_file(root / "studies/c.toml", "title = 'C'\nscene = 's.toml'\n");
  write_file(root / "studies/i.toml", "[[video]]\nfile = 'x.mp4'\n[[model]]\ntype = 'basic'\n");
  write_file(root / "experiments/one/experiment.toml", "title = 'One'\n");
  std::map<std::string, std::set<std::string>> found;
  std::map<std::string, Json> of;
  for (const Json& e : input_files(Workspace(root, {}))) {
    found[e["kind"]].insert(e["file"].get<std::string>());
    of[e["file"]] = e;
  }
  using Set = std::set<std::string>;
  CHECK(found["video"] ==
        Set{"videos/v.mp4", "videos/sub/W.AVI", "frame.tif", "runs/a", "experiments/one/videos/e.mp4"});
  CHECK(found["picture"] == Set{"ruler.png", "frame.tif"});
  CHECK(found["table"] == Set{"readings.csv"});
  CHECK(found["coil_system"] == Set{"rigs/pair.toml"});
  CHECK(found["study"] == Set{"studies/c.toml", "studies/i.toml"});
  CHECK(found["scene"] == Set{"scenes/s.toml"});
  CHECK(found["experiment"] == Set{"experiments/one"});
  CHECK(of["rigs/pair.toml"]["coils"] == 2);
  CHECK(of["rigs/pair.toml"]["currents"] == true);
  CHECK(of["studies/c.toml"]["verb"] == "compare-controllers");
  CHECK(of["studies/i.toml"]["verb"] == "identify");
  CHECK(of["experiments/one"]["title"] == "One");
  CHECK(of["runs/a"]["run"] == true);
}
