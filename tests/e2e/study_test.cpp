// `faba compare-controllers`: files, the same result for shards and one process, resuming, and messages for
// invalid input.
#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/e2e/refused.h"

using namespace faba;

namespace {

const std::string kScene =
    "duration = \"3 s\"\n[arena]\ntype = \"box\"\nsize_px = [160, 120]\n[[swarm]]\ncount = 40\n"
    "model = { type = \"basic\", max_speed = 2 }\nstart = { type = \"edge\", direction = \"180 deg\" }\n"
    "[controller]\ntype = \"fuzzy\"\n[reference]\ntype = \"hold\"\nsetpoint_px = [80, 60]\n";
const std::string kStudy =
    "scene = \"scene.toml\"\nseeds = 3\ndelays = [0, 2]\n"
    "[[controller]]\nname = \"published\"\ntype = \"fuzzy\"\nmax_output = 5\n"
    "[[controller]]\ntype = \"proportional\"\n"
    "[[model]]\nname = \"slow\"\ntype = \"basic\"\nmax_speed = 2\nset = { \"swarm[0].count\" = 30 }\n"
    "[[model]]\nname = \"fast\"\ntype = \"adapted\"\nmax_speed = 4\n";

void write_study(const TestFolder& f, const std::string& study = kStudy) {
  write_file(f.path / "scene.toml", kScene);
  write_file(f.path / "study.toml", study);
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& e : std::filesystem::directory_iterator(folder)) files.push_back(e.path());
  return files;
}

}  // namespace

TEST_CASE("a study of controllers: all combinations, with the same results as single runs") {
  const TestFolder f;
  write_study(f);
  const Called c = faba_in(f.path, "compare-controllers study.toml --out out --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto all = c.json()["combinations"];
  REQUIRE(all.size() == 8);
  CHECK(all[0]["controller"] == "published");
  CHECK(all[3]["controller"] == "proportional");
  CHECK(all[3]["delay_frames"] == 2);
  CHECK(all[4]["model"] == "fast");
  for (const char* name : {"controllers.json", "controllers.csv", "report.html"})
    CHECK(std::filesystem::exists(f.path / "out" / name));
  CHECK_FALSE(std::filesystem::exists(f.path / "out/incomplete"));
  // The third combination, with single runs.
  double mean = 0;
  for (const char* seed : {"1", "2", "3"}) {
    const Called one = faba_in(f.path, std::string("run scene.toml --json --force --out one --seed ") + seed +
                                           " --set swarm[0].count=30 --set camera.delay_frames=2 "
                                           "--set controller.max_output=5");
    REQUIRE_MESSAGE(one.exit == 0, one.err);
    mean += one.json()["steady_rms_px"].get<double>() / 3;
  }
  CHECK(all[2]["metrics"]["steady_rms_px"]["mean"].get<double>() == doctest::Approx(mean).epsilon(1e-7));
  CHECK(all[2]["metrics"]["steady_rms_px"]["n"] == 3);
}

TEST_CASE("four merged shards and one process give identical files") {
  const TestFolder f;
  write_study(f);
  const Called single = faba_in(f.path, "compare-controllers study.toml --out single --threads 2");
  REQUIRE(single.exit == 0);
  CHECK(single.out.starts_with("controller    model  delay, frames   settled    settling time s  "));
  std::string parts;
  for (const char* k : {"1", "2", "3", "4"}) {
    const Called c = faba_in(
        f.path, std::string("compare-controllers study.toml --json --shard ") + k + "/4 --out part" + k);
    REQUIRE_MESSAGE(c.exit == 0, c.err);
    CHECK(c.json()["complete"] == false);
    parts += std::string(" --merge part") + k;
  }
  const Called c = faba_in(f.path, "compare-controllers study.toml --out merged" + parts);
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  for (const char* name : {"controllers.json", "controllers.csv", "report.html"})
    CHECK(read_file(f.path / "single" / name) == read_file(f.path / "merged" / name));
  const auto p = nlohmann::json::parse(read_file(f.path / "single/controllers.json"))["provenance"];
  REQUIRE(p["inputs"].size() == 2);
  CHECK(p["inputs"][0]["path"] == "study.toml");
  CHECK(p["options"].empty());
  const auto about = nlohmann::json::parse(read_file(f.path / "single/study.json"));
  CHECK(about["threads"] == 2);
  CHECK(about["out"] == "single");
  CHECK(about["date"].get<std::string>().ends_with("Z"));
}

TEST_CASE("a study is resumed and not overwritten") {
  const TestFolder f;
  write_study(f);
  REQUIRE(faba_in(f.path, "compare-controllers study.toml --shard 1/2 --out out").exit == 0);
  REQUIRE(files_in(f.path / "out/results").size() == 1);
  const std::string half = read_file(files_in(f.path / "out/results").front());
  REQUIRE(faba_in(f.path, "compare-controllers study.toml --out out").exit == 0);
  std::set<std::string> all;
  for (const auto& file : files_in(f.path / "out/results")) all.insert(read_file(file));
  CHECK(all.size() == 2);
  CHECK(all.contains(half));
  for (const std::string& part : all) CHECK(part.size() == half.size());  // the other half of the trials
  const Called again = faba_in(f.path, "compare-controllers study.toml --out out");
  CHECK(again.exit == 0);
  CHECK(again.out.find("complete") != std::string::npos);
  CHECK(faba_in(f.path, "compare-controllers study.toml --json --out out").json()["complete"] == true);
  write_file(f.path / "other.toml", kStudy + "set = { \"swarm[0].count\" = 31 }\n");
  CHECK(faba_in(f.path, "compare-controllers other.toml --out out").exit == 2);
  CHECK(faba_in(f.path, "compare-controllers other.toml --out out --force").exit == 0);
}

TEST_CASE("invalid studies: one line with place and reason, before anything is written") {
  const TestFolder f;
  write_study(f);
  const auto invalid = [&f](const std::string& study, const std::string& words) {
    refused_study(f, "compare-controllers", study, 2, words);
  };
  invalid("seeds = 3\n", "scene");
  invalid("scene = \"none.toml\"\n",
          "refused.toml:1: scene: file not found: none.toml (relative to the study file)");
  invalid("scene = \"scene.toml\"\nsseds = 3\n", "did you mean \"seeds\"");
  invalid("scene = \"scene.toml\"\n[[controller]]\ntype = \"fuzy\"\n", "did you mean \"fuzzy\"");
  invalid("scene = \"scene.toml\"\n[[controller]]\nmax_output = 3\n", "type");
  invalid("scene = \"scene.toml\"\n[[controller]]\ntype = \"fuzzy\"\n[[controller]]\ntype = \"fuzzy\"\n",
          "names must be unique");
  invalid("scene = \"scene.toml\"\n[[model]]\ntype = \"basic\"\nset = { \"swarm[3].count\" = 2 }\n",
          "swarm[3]");
  invalid("scene = \"scene.toml\"\n[[model]]\ntype = \"basic\"\nset = { \"swarm[0].cuont\" = 2 }\n",
          "did you mean \"count\"");
  invalid("scene = \"scene.toml\"\n[[controller]]\ntype = \"manual\"\nset = { reference = \"none\" }\n",
          "setpoint");
  invalid("scene = \"scene.toml\"\nseeds = 1\n", "seeds");
  invalid("scene = \"scene.toml\"\ndelays = []\n",
          "refused.toml:2: delays: is an empty list; list camera delays");
  for (const char* shard : {"5/4", "0/4", "1", "a/b", "1/4x"}) {
    const Called c =
        faba_in(f.path, std::string("compare-controllers study.toml --out out --shard ") + shard);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
  }
  CHECK(faba_in(f.path, "compare-controllers study.toml --out out --merge nowhere").exit == 3);
}
