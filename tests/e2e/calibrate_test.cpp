// `faba calibrate`: the same result for any number of threads, for parts and after a kill; messages for
// invalid input.
#include <doctest/doctest.h>

#include <string>

#include "tests/e2e/refused.h"

using namespace faba;

namespace {

const std::string kFilm =
    "duration = \"3.2 s\"\n[arena]\ntype = \"box\"\nsize_px = [160, 120]\n[scale]\num_per_px = 1.2\n"
    "[microscope]\ncell_diameter = \"2.5 um\"\n"
    "[[swarm]]\ncount = 60\nmodel = { type = \"basic\", max_speed = 4 }\nstart = { type = \"edge\", "
    "direction = \"180 deg\" }\n"
    "[controller]\ntype = \"manual\"\nfield = [\"69 uT\", \"0 T\"]\n"
    "[[controller.segment]]\nat = \"0.6 s\"\nfield = [\"-69 uT\", \"0 T\"]\n"
    "[record]\nas_seen = true\nlossless = true\ntracks = false\n";
const std::string kDesign =
    "boundary = \"box\"\nlook = \"positions\"\nsimulations = 150\nfield_strength = \"69 uT\"\n"
    "[[video]]\nfile = \"film\"\n"
    "[[model]]\ntype = \"basic\"\nfree = { \"swarm[0].model.max_speed\" = [1, 12] }\n"
    "[[model]]\ntype = \"adapted\"\nfree = { \"swarm[0].model.max_speed\" = [1, 12] }\n";
const std::string kCalibration = "study = \"study.toml\"\nmodels = [\"basic\"]\nseed = 5\nexperiments = 6\n";

void make_design(const TestFolder& f) {
  write_file(f.path / "scene.toml", kFilm);
  write_file(f.path / "study.toml", kDesign);
  const Called c = faba_in(f.path, "run scene.toml --seed 3 --quiet --out film");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
}

}  // namespace

TEST_CASE("calibrate: threads, workers and a kill do not change the result") {
  const TestFolder f;
  make_design(f);
  write_file(f.path / "calibration.toml", kCalibration);
  const Called c = faba_in(f.path, "calibrate calibration.toml --json --threads 2 --out two");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto p = c.json()["models"]["basic"]["parameters"]["swarm[0].model.max_speed"];
  CHECK(p["coverage"].size() == 4);
  CHECK(p["coverage"][2]["experiments"] == 6);
  CHECK(c.json()["experiments"].size() == 6);
  for (const auto& e : c.json()["experiments"]) {
    const auto& one = e["parameters"]["swarm[0].model.max_speed"];
    CHECK(1 <= one["true"].get<double>());
    CHECK(one["true"].get<double>() <= 12);
    CHECK((0 <= one["rank"].get<double>() && one["rank"].get<double>() <= 1));
  }
  CHECK(read_file(f.path / "two/calibration.html").find("</html>") != std::string::npos);
  const std::string result = read_file(f.path / "two/calibration.json");

  REQUIRE(faba_in(f.path, "calibrate calibration.toml --quiet --threads 1 --out one").exit == 0);
  CHECK(read_file(f.path / "one/calibration.json") == result);

  REQUIRE(
      faba_in(f.path, "calibrate calibration.toml --quiet --engine local --workers 2 --out engine").exit ==
      0);
  CHECK(read_file(f.path / "engine/calibration.json") == result);

  write_file(f.path / "kill.sh", std::string("'") + FABA_PROGRAM +
                                     "' calibrate calibration.toml --quiet --threads 1 --out killed &\np=$!\n"
                                     "until [ $(cat killed/results/* 2> /dev/null | wc -c) -gt 200 ] || "
                                     "! kill -0 $p; do sleep 0.02; done\n"
                                     "kill -KILL $p\nwait $p\n");
  const int killed = std::system(("cd '" + f.path.string() + "' && sh kill.sh").c_str());
  CHECK(WEXITSTATUS(killed) == 137);
  CHECK(std::filesystem::exists(f.path / "killed/incomplete"));
  REQUIRE(faba_in(f.path, "calibrate calibration.toml --quiet --out killed").exit == 0);
  CHECK(read_file(f.path / "killed/calibration.json") == result);
}

TEST_CASE("calibrate: two candidates, misspecified and rendered experiments") {
  const TestFolder f;
  make_design(f);
  write_file(
      f.path / "calibration.toml",
      "study = \"study.toml\"\nlook = \"video\"\nexperiments = 1\n[[misspecified]]\nname = \"field\"\n"
      "field_factor = 0.3\nexperiments = 1\n[[misspecified]]\nname = \"opposite\"\nexperiments = 1\n"
      "second_swarm = 0.4\nset = { \"swarm[1].polarity\" = \"north\" }\ntrue_models = [\"adapted\"]\n");
  const auto j = json_in(f.path, "calibrate calibration.toml --out out");
  REQUIRE(j["kinds"].size() == 3);
  CHECK(j["kinds"][1]["kind"] == "field");
  CHECK(j["kinds"][2]["misspecified"] == true);
  CHECK(j["experiments"][0]["true_model"] == "basic");
  CHECK(j["experiments"][2]["true_model"] == "adapted");
  CHECK(j["models"]["basic"]["experiments"] == 1);
  const Called table = faba_in(f.path, "study export out --out tasks.csv --json");
  CHECK(table.json()["tasks"] == 3);
}

TEST_CASE("the page of identify shows the calibration of its study, and warns of a missing one") {
  const TestFolder f;
  make_design(f);
  write_file(f.path / "calibration.toml", "study = \"study.toml\"\nexperiments = 2\n");
  REQUIRE(faba_in(f.path, "calibrate calibration.toml --quiet --out calibrated").exit == 0);
  const auto page = [&](const std::string& more) {
    write_file(f.path / "more.toml", more + kDesign);
    const Called c = faba_in(f.path, "identify more.toml --quiet --force --out out");
    REQUIRE_MESSAGE(c.exit == 0, c.err);
    return read_file(f.path / "out/identify.html");
  };
  const std::string key = "calibration = \"calibrated/calibration.json\"\n";
  CHECK(page(key).find("Calibration of this study") != std::string::npos);
  CHECK(page(key + "seed = 7\n").find("Calibration of this study") != std::string::npos);
  CHECK(page(key + "timing = \"0 s\"\n").find("is of another design") != std::string::npos);
  CHECK(page("").find("are not calibrated") != std::string::npos);
  CHECK(page("calibration = \"none.json\"\n").find("none.json does not exist") != std::string::npos);
}

TEST_CASE("calibrate: invalid files are refused before the videos are read") {
  const TestFolder f;
  make_design(f);
  refused_study(f, "calibrate", "experiments = 5\n", 2, "\"study\" is missing");
  refused_study(f, "calibrate", "study = \"none.toml\"\n", 2, "file not found: none.toml");
  refused_study(f, "calibrate", "study = \"scene.toml\"\n", 2, "is a scenario");
  refused_study(f, "calibrate", "study = \"study.toml\"\nmodels = [\"dipole\"]\n", 2,
                "unknown model \"dipole\"; the study identifies: basic, adapted");
  refused_study(f, "calibrate", "study = \"study.toml\"\nexperiments = 0\n", 2, "no [[misspecified]]");
  refused_study(f, "calibrate", "study = \"study.toml\"\n[[misspecified]]\nname = \"none\"\n", 2,
                "nothing differs");
  refused_study(f, "calibrate", "study = \"study.toml\"\n[[misspecified]]\nfield_factor = 2\n", 2,
                "\"name\" is missing");
  refused_study(f, "calibrate", kFilm, 2, "is a scenario");
  refused_study(f, "calibrate", "[[video]]\nfile = \"film\"\n", 2, "[[model]] is missing");
  refused_study(f, "calibrate",
                "study = \"study.toml\"\n[[misspecified]]\nname = \"drift\"\ntiming = \"0 s\"\naspects = "
                "[\"drifts\"]\n",
                2, "unknown aspect \"drifts\"; it must be one of turning, ");
}

TEST_CASE("calibrate: a value that no scenario has is refused with the line of the file") {
  const TestFolder f;
  make_design(f);
  write_file(
      f.path / "calibration.toml",
      "study = \"study.toml\"\n[[misspecified]]\nname = \"none\"\nset = { \"swarm[0].model.sped\" = 3 }\n");
  const Called c = faba_in(f.path, "calibrate calibration.toml --quiet --out out");
  CHECK(c.exit == 2);
  CHECK(c.err.find("calibration.toml:4: misspecified[0].set: swarm[0].model.sped: unknown key") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(f.path / "out"));
}

TEST_CASE("calibrate: one experiment has no standard error, and is too few") {
  const TestFolder f;
  make_design(f);
  write_file(f.path / "calibration.toml", "study = \"study.toml\"\nmodels = [\"basic\"]\nexperiments = 1\n");
  const auto j = json_in(f.path, "calibrate calibration.toml --out out");
  const auto p = j["models"]["basic"]["parameters"]["swarm[0].model.max_speed"];
  CHECK(p["bias_sd"]["mean"].is_number());
  CHECK(p["bias_sd"]["se"].is_null());
  CHECK(j["quality"] == "doubtful");
  CHECK(j["warnings"][0]["aspect"] == "experiments");
}

TEST_CASE("calibrate: a full disk, an interruption and a second process lose nothing") {
  const TestFolder f;
  make_design(f);
  write_file(f.path / "calibration.toml", kCalibration);
  REQUIRE(faba_in(f.path, "calibrate calibration.toml --quiet --out one").exit == 0);
  // A limit of the file size has the effect of a full disk; the measurements are the largest file.
  write_file(f.path / "full.sh", std::string("ulimit -f 100\n'") + FABA_PROGRAM +
                                     "' calibrate calibration.toml --quiet --out full 2> full.txt\n");
  CHECK(WEXITSTATUS(std::system(("cd '" + f.path.string() + "' && sh full.sh").c_str())) == 1);
  CHECK(read_file(f.path / "full.txt").find("cannot be written") != std::string::npos);
  // While the first process waits, the second one is refused; the first one is then interrupted.
  write_file(f.path / "two.sh",
             std::string("'") + FABA_PROGRAM +
                 "' calibrate calibration.toml --quiet --threads 1 --out full 2> int.txt &\n"
                 "p=$!\nuntil [ $(cat full/results/* 2> /dev/null | wc -c) -gt 200 ] || "
                 "! kill -0 $p; do sleep 0.02; done\nkill -STOP $p\n'" +
                 FABA_PROGRAM +
                 "' calibrate calibration.toml --quiet --out full 2> busy.txt\n"
                 "echo $? > busy.code\nkill -INT $p\nkill -CONT $p\nwait $p\n");
  CHECK(WEXITSTATUS(std::system(("cd '" + f.path.string() + "' && bash -m two.sh").c_str())) == 130);
  CHECK(read_file(f.path / "busy.code") == "11\n");
  CHECK(read_file(f.path / "busy.txt").find("is writing to it") != std::string::npos);
  CHECK(read_file(f.path / "int.txt").find("completed results are kept") != std::string::npos);
  REQUIRE(faba_in(f.path, "calibrate calibration.toml --quiet --out full").exit == 0);
  CHECK(read_file(f.path / "full/calibration.json") == read_file(f.path / "one/calibration.json"));
  CHECK(read_file(f.path / "full/calibration.html") == read_file(f.path / "one/calibration.html"));
}
