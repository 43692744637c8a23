// `faba design`, `faba tune` and `faba benchmark-control`: results, the same on any number of threads, and
// messages.
#include <fmt/format.h>

#include <cmath>

#include "core/file.h"
#include "tests/e2e/program.h"
#include "tests/e2e/refused.h"

using namespace faba;

namespace {

// A hold that takes a few milliseconds: cells of the published model in a box.
const std::string kHold =
    "duration = '6 s'\n[camera]\nrate = 15\n[arena]\ntype = 'box'\nsize_px = [320, 240]\n"
    "[[swarm]]\ncount = 60\nmodel = 'basic'\nstart = { type = 'disc', centre_px = [80, 120], radius_px = 20 "
    "}\n"
    "[controller]\ntype = 'proportional'\ngain = 0.1\n[reference]\ntype = 'hold'\nsetpoint_px = [200, 120]\n";

}  // namespace

TEST_CASE("design: gains, poles and margins of the regulator, and advice for other controllers") {
  const TestFolder f;
  const auto j = json_in(f.path, "design '" FABA_SCENES "/bench.toml' --set 'controller={type=\"lqr\"}'");
  REQUIRE(j["poles"].size() == 2);
  for (const auto& pole : j["poles"])
    CHECK(std::hypot(pole["re"].get<double>(), pole["im"].get<double>()) < 1);
  // Butterworth poles of a double integrator (theory F3): damping 0.707, phase margin 65.5 degrees; the decay
  // of the velocity and the sampled command change them by a few percent.
  CHECK(j["poles"][0]["damping"].get<double>() == doctest::Approx(0.707).epsilon(0.1));
  // Of the 65.5 degrees the held command takes half a frame at the crossing, 1.554 sqrt(g / error): 20.5
  // degrees. The design for the sampled plant recovers a part of them.
  const double g = j["plant"]["acceleration_um_per_s2"].get<double>(),
               crossing = 1.554 * std::sqrt(g / (2 * 0.9164));
  CHECK(j["phase_margin_deg"].get<double>() > 65.5 - crossing / 60 / 2 * 180 / 3.14159265);
  CHECK(j["phase_margin_deg"].get<double>() < 65.5);
  CHECK(j["gain_margin"].get<double>() > 1);
  CHECK(j["plant"]["acceleration_um_per_s2"].get<double>() > 0);
  // The design is linear: what limits the scenario is a note.
  const std::string lqr = "design '" FABA_SCENES "/bench.toml' --set 'controller={type=\"lqr\"}' --set ";
  const auto idle = json_in(f.path, lqr + "'limits.max_current=\"0 A\"'");
  REQUIRE(idle["notes"].size() == 1);
  CHECK(idle["notes"][0].get<std::string>().find("there is no current in the coils") != std::string::npos);
  const auto two = json_in(f.path, lqr + "'field.file=\"" FABA_SCENES "/../rigs/thesis-two-coils.toml\"'");
  REQUIRE(two["notes"].size() == 1);
  CHECK(two["notes"][0].get<std::string>().find("nearly along one line") != std::string::npos);
  CHECK(j["notes"].empty());
  const Called old = faba_in(f.path, lqr + "camera.delay_frames=1000");
  CHECK(old.exit == 2);
  CHECK(old.err.find("more than limits.max_frame_age") != std::string::npos);
  const Called c = faba_in(f.path, "design '" FABA_SCENES "/bench.toml'");
  CHECK(c.exit == 2);
  CHECK(c.err.find("add --set 'controller={type=\"lqr\"}'") != std::string::npos);
}

TEST_CASE(
    "tune: better on seeds that it has not seen, the same on one and two threads, and after an "
    "interruption") {
  const TestFolder f;
  write_file(f.path / "hold.toml", kHold);
  const std::string words = "tune hold.toml --range gain=0.02..1 --evaluations 12 --seeds 4 --held-out 6 ";
  const auto j = json_in(f.path, words + "--out one --threads 1");
  CHECK(j["complete"] == true);
  CHECK(j["metric"] == "steady_rms_px");
  REQUIRE(j["parameters"].size() == 1);
  CHECK(j["parameters"][0]["given"] == 0.1);
  CHECK(j["held_out"]["difference"]["ci95"][1].get<double>() < 0);
  CHECK(j["held_out"]["tuned"]["mean"].get<double>() < j["held_out"]["given"]["mean"].get<double>());
  CHECK(j["evaluated"].size() <= 13);
  REQUIRE(faba_in(f.path, words + "--out two --threads 2 --quiet").exit == 0);
  CHECK(read_file(f.path / "one/tuning.json") == read_file(f.path / "two/tuning.json"));
  CHECK(read_file(f.path / "one/report.html") == read_file(f.path / "two/report.html"));
  // The scenario that it writes, with the held-out seeds, has the mean that the report states.
  double mean = 0;
  for (int seed = 1; seed <= 6; ++seed)
    mean += json_in(f.path,
                    fmt::format("run one/tuned.toml --seed {} --set record.video=false --force --out again",
                                seed))["steady_rms_px"]
                .get<double>() /
            6;
  CHECK(mean == doctest::Approx(j["held_out"]["tuned"]["mean"].get<double>()).epsilon(1e-9));
  // An engine gives the same bytes.
  REQUIRE(faba_in(f.path, words + "--out engine --engine local --quiet").exit == 0);
  CHECK(read_file(f.path / "one/tuning.json") == read_file(f.path / "engine/tuning.json"));
}

TEST_CASE("tune: refuses what it cannot tune") {
  const TestFolder f;
  write_file(f.path / "hold.toml", kHold);
  const auto refuses = [&](const std::string& words, const std::string& reason) {
    const Called c = faba_in(f.path, "tune hold.toml " + words);
    INFO(c.err);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
    CHECK(c.err.find(reason) != std::string::npos);
  };
  refuses("--range gain=1..0.1", "0 < LOW < HIGH");
  refuses("--range gain", "KEY=LOW..HIGH");
  refuses("--range gian=0.1..1", "did you mean \"gain\"?");
  refuses("--range 'lead=1 m..2 m'", "time");
  refuses("--metric speed", "not a metric of controllers");
  refuses("--controller gradient", "has no number that can be tuned");
  refuses("--metric coil_heat_w", "no coil of the field has a resistance");
  refuses("--metric keep_out_cells", "cases of `faba benchmark-control` only");
  refuses("--controller nothing", "unknown controller");
  CHECK_FALSE(std::filesystem::exists(f.path / "runs"));
}

TEST_CASE("benchmark-control: tables of all cases, comparison with the baseline, and forbidden regions") {
  const TestFolder f;
  write_file(f.path / "hold.toml", kHold);
  write_file(f.path / "bench.toml",
             "title = 'Small'\nversion = 3\nseeds = 4\n"
             "[[controller]]\nname = 'slow'\ntype = 'proportional'\ngain = 0.05\n"
             "[[controller]]\nname = 'plan'\ntype = 'mpc'\n"
             "[[case]]\nname = 'free'\nabout = 'One setpoint.'\nscene = 'hold.toml'\ndelays = [0, "
             "1]\nbaseline = ['slow']\n"
             "literature = 'A published figure.'\nspeed = '30 um/s'\n"
             "[[case]]\nname = 'obstacle'\nscene = 'hold.toml'\nset = { duration = '12 s' }\n"
             "[[case.keep_out]]\ncorners_px = [[130, 100], [150, 100], [150, 140], [130, 140]]\n");
  const auto j = json_in(f.path, "benchmark-control bench.toml --out one --threads 2");
  REQUIRE(j["cases"].size() == 2);
  CHECK(j["version_of_cases"] == 3);
  const auto& free = j["cases"][0];
  REQUIRE(free["combinations"].size() == 4);
  CHECK(free["combinations"][1]["baseline"] == "slow");
  CHECK(free["combinations"][1]["minus_baseline"]["steady_rms_px"]["ci95"][1].get<double>() < 0);
  const auto& obstacle = j["cases"][1]["combinations"];
  CHECK(obstacle[0]["metrics"]["keep_out_fraction"]["mean"].get<double>() >
        0);  // it does not know the region
  CHECK(obstacle[1]["metrics"]["keep_out_fraction"]["mean"].get<double>() == 0);
  const std::string page = read_file(f.path / "one/control.md");
  for (const char* text :
       {"## free", "## obstacle", "A published figure.", "largest distance / speed, s", "| plan |"})
    CHECK(page.find(text) != std::string::npos);
  // Of all trials of a controller: 4 seeds in 2 delays of "free" and in the one of "obstacle".
  CHECK(page.find("## Constraints") != std::string::npos);
  CHECK(page.find("| plan | 12 | 0 | 0 |") != std::string::npos);
  CHECK(page.find("| slow | 12 | 0 | 0 |") == std::string::npos);
  CHECK(std::filesystem::exists(f.path / "one/cycles.csv"));
  REQUIRE(faba_in(f.path, "benchmark-control bench.toml --out two --threads 1 --quiet").exit == 0);
  CHECK(read_file(f.path / "one/benchmark.json") == read_file(f.path / "two/benchmark.json"));
  REQUIRE(faba_in(f.path, "benchmark-control bench.toml --out engine --engine local --quiet").exit == 0);
  CHECK(read_file(f.path / "one/benchmark.json") == read_file(f.path / "engine/benchmark.json"));

  const Called unknown = faba_in(f.path, "benchmark-control bench.toml --only fre");
  CHECK(unknown.exit == 2);
  CHECK(unknown.err.find("did you mean \"free\"?") != std::string::npos);
}

TEST_CASE("a run around an obstacle: its report draws the obstacle and states the distance from it") {
  const TestFolder f;
  write_file(f.path / "hold.toml", kHold);
  const auto run = [&](const std::string& controller) {
    return faba_in(f.path,
                   "run hold.toml --seed 1 --quiet --force --set record.video=false --set duration=12 --set "
                   "reference.setpoint_px=[200,120] --out o --set 'controller=" +
                       controller + "'")
        .exit;
  };
  const std::string polygon = "corners_px=[[130,100],[150,100],[150,140],[130,140]]";
  REQUIRE(run("{type=\"mpc\",obstacle=[{" + polygon + "}]}") == 0);
  const auto manifest = nlohmann::json::parse(read_file(f.path / "o/manifest.json"));
  CHECK(manifest["obstacles_px"] == nlohmann::json({{{130, 100}, {150, 100}, {150, 140}, {130, 140}}}));
  const std::string report = read_file(f.path / "o/report.html");
  CHECK(report.find("Smallest distance of the path from an obstacle: ") != std::string::npos);
  CHECK(report.find(">obstacle<") != std::string::npos);
  REQUIRE(run("{type=\"lqr\"}") == 0);
  CHECK_FALSE(nlohmann::json::parse(read_file(f.path / "o/manifest.json")).contains("obstacles_px"));
  CHECK(read_file(f.path / "o/report.html").find("obstacle:") == std::string::npos);
}
