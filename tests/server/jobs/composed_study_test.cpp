#include "server/jobs/composed_study.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "study/identify/identify_study.h"
#include "study/steering/controller_study.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

const JobKind& kIdentify = job_kind("identify");
const JobKind& kControllers = job_kind("compare-controllers");

struct Place {
  test::TemporaryFolder folder{"composed"};
  Place() {
    fs::create_directories(folder.path() / "scenes");
    fs::create_directories(folder.path() / "experiments/one");
    write_file(folder.path() / "scenes/s.toml",
               "duration = '1 s'\n[arena]\ntype = 'drop'\nradius_px = 100\n[[swarm]]\ncount = "
               "10\n[controller]\ntype "
               "= 'proportional'\n[reference]\ntype = 'hold'\nsetpoint_px = [330, 250]\n");
  }
  Workspace workspace{folder.path(), folder.path() / "scenes"};
  ComposedStudy compose(const JobKind& kind, const Json& asked) const {
    return compose_study(kind, asked, workspace);
  }
  std::string error(const JobKind& kind, const Json& asked) const {
    try {
      (void)compose(kind, asked);
    } catch (const Error& e) {
      return e.what();
    }
    FAIL("accepted: " << asked.dump());
    return "";
  }
};

Json sweep(const Json& set) {
  return {{"name", "My sweep"},
          {"study",
           {{"title", "My sweep"},
            {"scene", "scenes/s.toml"},
            {"seeds", 3},
            {"model", {{{"name", "a"}, {"set", set}}}}}}};
}

}  // namespace

TEST_CASE("a composed study is a file that the terminal can run") {
  const Place p;
  const ComposedStudy s = p.compose(kControllers, sweep({{"swarm[0].count", 20}}));
  CHECK(s.file == "studies/My-sweep.toml");
  CHECK(s.work > 0);
  const ControllerStudy read = read_controller_study(p.folder.path() / s.file);
  CHECK(read.seeds == 3);
  REQUIRE(read.models.size() == 1);
  CHECK(read.models[0].set.at(0).first == "swarm[0].count");
  // The same study again is the same file; another one gets a number.
  CHECK(p.compose(kControllers, sweep({{"swarm[0].count", 20}})).file == "studies/My-sweep.toml");
  CHECK(p.compose(kControllers, sweep({{"swarm[0].count", 30}})).file == "studies/My-sweep-2.toml");
}

TEST_CASE("a draft leaves no file") {
  const Place p;
  Json asked = sweep({{"swarm[0].count", 20}});
  asked["draft"] = true;
  CHECK(p.compose(kControllers, asked).toml.find("seeds = 3") != std::string::npos);
  CHECK_FALSE(fs::exists(p.folder.path() / "studies"));
}

TEST_CASE("a study of an experiment is in its folder, with its files relative to it") {
  const Place p;
  Json asked = sweep({{"swarm[0].count", 20}});
  asked["folder"] = "experiments/one";
  const ComposedStudy s = p.compose(kControllers, asked);
  CHECK(s.file == "experiments/one/studies/My-sweep.toml");
  CHECK(s.toml.find("../../../scenes/s.toml") != std::string::npos);
}

TEST_CASE(
    "an invalid study is refused with its place, without names of temporary files, and leaves no file") {
  const Place p;
  for (const Json& set : {Json{{"swarm[0].cuont", 20}}, Json{{"swarm[0].count", -5}}}) {
    const std::string e = p.error(kControllers, sweep(set));
    CHECK(e.find("draft") == std::string::npos);
    CHECK(e.find(p.folder.path().string()) == std::string::npos);
    CHECK(e.find("swarm[0].c") != std::string::npos);
  }
  CHECK_FALSE(fs::exists(p.folder.path() / "studies"));
}

TEST_CASE("files of a study are inside the workspace") {
  const Place p;
  Json asked = sweep({{"swarm[0].count", 20}});
  for (const char* scene : {"../x.toml", "/etc/passwd", "scenes/none.toml", "scenes/../../x"}) {
    asked["study"]["scene"] = scene;
    CHECK(p.error(kControllers, asked).starts_with("scene: "));
  }
  CHECK(p.error(kControllers, sweep({{"arena.background", "/etc/passwd"}}))
            .find("model[0].set.arena.background") == 0);
  CHECK(p.error(kControllers, sweep({{"rig.camera.file", "/etc/passwd1"}})).find("is the name of a file") !=
        std::string::npos);
  CHECK(p.error(kIdentify, {{"name", "x"}, {"study", {{"video", {{{"file", "../a.mp4"}}}}}}})
            .starts_with("video[0].file: "));
  for (const char* name : {"", "..", "/", "-"})
    CHECK(p.error(kControllers, {{"name", name}, {"study", Json::object()}}).starts_with("name: "));
  CHECK(p.error(job_kind("drop"), sweep({})).starts_with("kind: "));
}

TEST_CASE("directions of a page are turned for the study file") {
  const Place p;
  fs::create_directories(p.folder.path() / "videos");
  write_file(p.folder.path() / "videos/a.mp4", "");
  Json asked = {
      {"name", "turn"},
      {"draft", true},
      {"study",
       {{"video",
         {{{"file", "videos/a.mp4"}, {"direction", "90 deg"}, {"reversal", "1 s"}, {"um_per_px", 1}}}},
        {"model", {{{"type", "dipole"}, {"free", {{"swarm[0].model.speed", {"20 um/s", "300 um/s"}}}}}}}}}};
  // The file is not a video: the estimate of the work reports it after the study was read.
  CHECK(p.error(kIdentify, asked).find("a.mp4") != std::string::npos);
  write_file(p.folder.path() / "videos/a.mp4", "P5\n2 2\n255\nabcd");  // a picture is the smallest video
  CHECK(p.compose(kIdentify, asked).toml.find("direction = \"270 deg\"") != std::string::npos);  // up
  asked["study"]["video"][0]["direction"] = "500 deg";
  CHECK(p.error(kIdentify, asked).starts_with("video[0].direction: 500 deg is out of range"));
}
