// The bench of the lab: captures, runs and jog on a simulated bench, and who may arm the coils.
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "core/table.h"
#include "server/bench/bench_console.h"
#include "study/experiment/experiment.h"
#include "tests/e2e/lab_program.h"
#include "tests/e2e/page_client.h"
#include "tests/skip.h"
#include "vision/files/video_reader.h"

using namespace faba;
using namespace faba::test;
namespace fs = std::filesystem;

namespace {

// Long deadlines of the guard: these tests are of something else, and a busy machine can stall.
const std::string kBench =
    "title = 'Bench'\nduration = '20 s'\nseed = 1\ncamera = { rate = '30 Hz' }\n"
    "limits = { max_current = '0.4 A' }\narena = { type = 'box', size_px = [160, 120] }\n"
    "estimator = 'image'\ncontroller = { type = 'manual', current = [0.3, -0.2] }\n"
    "[[swarm]]\ncount = 30\nmodel = { type = 'dipole', preset = 'IT-1' }\n"
    "[rig]\ncamera_timeout = '5 s'\nguard = { heartbeat_deadline = '1 s', command_deadline = '1 s' }\n"
    "step_response = { gather = '1 s', before = '0.5 s', record = '1 s', field = '20 uT' }\n";

struct BenchLab {
  explicit BenchLab(const std::string& more = "") : folder("bench"), lab(folder.path()), page(started(more)) {
    REQUIRE(page.page > 0);
    const Json opened = page.post("/api/bench/open", {{"scene", "bench"}});
    INFO(opened.dump());
    REQUIRE(opened["open"] == "bench");
  }
  Json state() const { return page.get("/api/bench"); }
  // Waits until the state fulfils a condition; returns it.
  Json until(const std::function<bool(const Json&)>& condition, double patience_s = 30) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
    Json s = state();
    while (!condition(s) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      s = state();
    }
    INFO(s.dump());
    REQUIRE(condition(s));
    return s;
  }
  Json until_idle() const {
    return until([](const Json& s) { return s["activity"].is_null(); });
  }
  Json until_armed() const {
    return until([](const Json& s) { return s["armed"] == true; });
  }

  LabAccess& started(const std::string& more) {
    write_file(lab.folder() / "scenes/bench.toml", kBench + more);
    lab.start();
    return lab;
  }

  TemporaryFolder folder;
  LabProgram lab;
  PageClient page;
};

}  // namespace

TEST_CASE("the live view has pictures, a histogram, and the position of the swarm") {
  test::works_in_real_time();
  const BenchLab b;
  const Json s = b.until([](const Json& j) { return j["frames"] > 3 && !j["estimate"].is_null(); });
  CHECK(s["size_px"] == Json{160, 120});
  CHECK(s["armed"] == false);
  CHECK(s["activity"].is_null());
  std::uint64_t pixels = 0;
  for (const Json& bin : s["histogram"]) pixels += bin.get<std::uint64_t>();
  CHECK(pixels == 160 * 120);
  CHECK(s["coils"].size() == 2);
  CHECK(s["coils"][0]["max_a"] == doctest::Approx(0.4));
  CHECK(b.lab.get("/api/bench/picture.png").find("\x89PNG") != std::string::npos);
  // A refused value leaves the camera's value.
  const Json refused = b.page.post("/api/bench/control", {{"name", "gain"}, {"value", 1000}});
  CHECK(refused["status"] == 422);
  CHECK(refused["where"] == "gain");
  CHECK(b.state()["controls"][0]["value"] == 1);
  CHECK(b.page.post("/api/bench/close")["open"].is_null());
}

TEST_CASE("a capture keeps the frames that were asked for, and becomes a video of an experiment") {
  test::works_in_real_time();
  const BenchLab b;
  const std::string experiment = b.page.post("/api/experiments", {{"title", "Ageing"}})["name"];
  b.page.post("/api/bench/sample", {{"exposure_s", 100}});
  const Json asked = {
      {"frames", 20}, {"one_of", 2}, {"name", "look"}, {"experiment", experiment}, {"drop", "A"}};
  REQUIRE(b.page.post("/api/bench/capture", asked)["status"] == 200);
  CHECK(b.page.post("/api/bench/capture", asked)["status"] == 422);  // one at a time
  CHECK(b.page.post("/api/bench/open", {{"scene", "bench"}})["status"] == 422);
  const Json done = b.until_idle()["finished"][0];
  INFO(done.dump());
  CHECK(done["ok"] == true);
  CHECK(done["taken"] == 20);
  CHECK(done["kept"] == 10);
  const std::string out = done["out"];
  CHECK(out.starts_with("experiments/" + experiment + "/"));
  VideoReader video(b.lab.folder() / out);
  CHECK(video.frames_in_header() == 10);
  const Experiment e = read_experiment(b.lab.folder() / "experiments" / experiment / "experiment.toml");
  REQUIRE(e.videos.size() == 1);
  CHECK(e.videos[0].drop == "A");
  CHECK(e.videos[0].exposure_s.value() >= 100);
  CHECK(e.videos[0].exposure_s.value() < 130);
}

TEST_CASE("only corrupt frames are kept if they are asked for") {
  test::works_in_real_time();
  const BenchLab b("[rig.bench]\ncorrupt_one_of = 5\n");
  const Json asked = {{"frames", 25}, {"only_corrupt", true}, {"format", "pgm"}};
  REQUIRE(b.page.post("/api/bench/capture", asked)["status"] == 200);
  const Json done = b.until_idle()["finished"][0];
  INFO(done.dump());
  CHECK(done["taken"] == 25);
  const int kept = done["kept"];
  CHECK(kept == done["corrupt"]);
  CHECK(kept >= 1);
  const Table times =
      read_table(b.lab.folder() / done["out"].get<std::string>() / "times.csv", LastLine::keep);
  for (const double number : times.column("camera_frame")) CHECK(std::fmod(number, 5) == 0);
}

TEST_CASE("a run needs a permit, is recorded, and ends when the coils are switched off") {
  test::works_in_real_time();
  const BenchLab b;
  const std::uint64_t page = b.page.page;
  CHECK(b.page.post("/api/bench/run", {{"page", page}, {"permit", "guess"}})["status"] == 422);
  CHECK(b.page.post("/api/bench/run", {{"page", page}})["status"] == 422);
  CHECK(b.state()["activity"].is_null());
  {  // a second page may watch, but does not get a permit
    const PageClient other(b.lab);
    CHECK(other.post("/api/bench/permit", {{"page", other.page}, {"what", "run"}})["status"] == 422);
    // A page cannot use the permit of another one.
    const Json permit = b.page.post("/api/bench/permit", {{"page", page}, {"what", "run"}});
    CHECK(other.post("/api/bench/run", {{"page", other.page}, {"permit", permit["permit"]}})["status"] ==
          422);
  }
  REQUIRE(b.page.armed("run", {{"duration_s", 20}, {"name", "held"}})["status"] == 200);
  const Json armed = b.until_armed();
  CHECK(armed["activity"]["kind"] == "run");
  b.until([](const Json& s) { return s["coils"][0]["current_a"] > 0.29; });
  b.page.post("/api/bench/off");
  const Json done = b.until_idle();
  CHECK(done["armed"] == false);
  CHECK(done["finished"][0]["out"] == "runs/held");
  CHECK(done["finished"][0]["what"] == "stopped by the user");
  CHECK(fs::exists(b.lab.folder() / "runs/held/report.html"));
}

TEST_CASE("a permit of a page that was reloaded does not arm the coils") {
  test::works_in_real_time();
  const BenchLab b;
  std::string permit;
  std::uint64_t old = 0;
  {
    const PageClient page(b.lab);
    old = page.page;
    // It takes control, then its connection ends.
    Json answer = page.post("/api/bench/permit", {{"page", old}, {"what", "run"}});
    CHECK(answer["status"] == 422);
  }
  permit = b.page.post("/api/bench/permit", {{"page", b.page.page}, {"what", "run"}})["permit"];
  // Messages of an old page, of another page and of a later opening of the bench.
  CHECK(b.page.post("/api/bench/run", {{"page", old}, {"permit", permit}})["status"] == 422);
  permit = b.page.post("/api/bench/permit", {{"page", b.page.page}, {"what", "run"}})["permit"];
  b.page.post("/api/bench/open", {{"scene", "bench"}});
  CHECK(b.page.post("/api/bench/run", {{"page", b.page.page}, {"permit", permit}})["status"] == 422);
  CHECK(b.state()["armed"] == false);
}

TEST_CASE("step responses have field, exposure and polarity in the experiment") {
  test::works_in_real_time();
  const BenchLab b;
  const std::string experiment = b.page.post("/api/experiments", {{"title", "Steps"}})["name"];
  b.page.post("/api/bench/sample", {{"exposure_s", 60}});
  REQUIRE(b.page.armed("step-response", {{"repeat", 2},
                                         {"every_s", 0},
                                         {"direction_deg", 180},
                                         {"experiment", experiment},
                                         {"drop", "A"}})["status"] == 200);
  const Json done = b.until_idle()["finished"][0];
  INFO(done.dump());
  REQUIRE(done["ok"] == true);
  const Experiment e = read_experiment(b.lab.folder() / "experiments" / experiment / "experiment.toml");
  REQUIRE(e.videos.size() == 2);
  CHECK(e.videos[1].exposure_s.value() > e.videos[0].exposure_s.value());
  // In the time of the video: 0.5 s, or less if the camera has dropped frames before.
  CHECK(e.videos[0].reversal_s.value() <= 0.5 + 1 / 30.);
  CHECK(e.videos[0].reversal_s.value() > 0.2);
  CHECK(e.videos[0].field_strength.value() == doctest::Approx(20e-6));
  CHECK(e.drops[0].polarity == CellPolarity::south);
  // The cells swam to the left (180) and swim to the right (0) after the reversal.
  CHECK(swimming_direction_deg(e, e.videos[0]).value() == doctest::Approx(0));
}

TEST_CASE("a jog ends when its page is silent, and old messages change nothing") {
  test::works_in_real_time();
  const BenchLab b;
  const Json jog = b.page.armed("jog");
  REQUIRE(jog["status"] == 200);
  const std::string session = jog["session"];
  std::uint64_t number = 0;
  const auto set = [&](std::uint64_t n, const std::string& secret) {
    return b.page.post("/api/bench/jog/set",
                       {{"session", secret}, {"number", n}, {"currents_a", {0.1, 0.9}}});
  };
  Json s;
  for (int i = 0; i < 100 && !(s.contains("armed") && s["armed"] == true); ++i) {
    s = set(++number, session);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  INFO(s.dump());
  REQUIRE(s["armed"] == true);
  s = set(++number, session);
  CHECK(set(number, session)["status"] == 422);  // a repeated message
  CHECK(set(number + 1, std::string(32, '0'))["status"] == 422);
  const Json all = b.state();
  CHECK(all["coils"][1]["current_a"] <= 0.4 + 1e-12);  // within the limits of the coil
  const auto silent = std::chrono::steady_clock::now();
  const Json ended = b.until_idle();
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - silent).count();
  CHECK(took < BenchConsole::kJogDeadline + 1);
  CHECK(ended["armed"] == false);
  CHECK(ended["finished"][0]["what"].get<std::string>().find("silent") != std::string::npos);
  CHECK(set(number + 5, session)["status"] == 422);
}

TEST_CASE("a camera that stalls ends a capture with a message; the recorded frames are kept") {
  test::works_in_real_time();
  const BenchLab b("[rig.bench]\nfreeze_after = '4 s'\n");
  REQUIRE(b.page.post("/api/bench/capture", {{"time_s", 60}})["status"] == 200);
  const Json s = b.until_idle();
  const Json done = s["finished"][0];
  INFO(done.dump());
  CHECK(done["ok"] == false);
  const std::string what = done["what"];
  CHECK(what.find("no picture for 5 s") != std::string::npos);
  CHECK(what.find(".part") != std::string::npos);
  CHECK(fs::exists(b.lab.folder() / (done["out"].get<std::string>() + ".part")));
  CHECK(s["trouble"].get<std::string>().find("no picture") != std::string::npos);
}

TEST_CASE("a full disk ends a capture with a message") {
  test::works_in_real_time();
  const BenchLab b;
  const fs::path disk = b.lab.folder() / "captures";
  fs::create_directory(disk);
  if (geteuid() != 0 ||
      std::system(("mount -t tmpfs -o size=300k tmpfs '" + disk.string() + "' 2> /dev/null").c_str()) != 0) {
    test::skip("mounting a small file system is not permitted");
    return;
  }
  b.page.post("/api/bench/capture", {{"format", "pgm"}, {"time_s", 60}});
  const Json done = b.until_idle()["finished"][0];
  CHECK(std::system(("umount '" + disk.string() + "'").c_str()) == 0);
  INFO(done.dump());
  CHECK(done["ok"] == false);
  CHECK(done["what"].get<std::string>().find("No space left") != std::string::npos);
}
