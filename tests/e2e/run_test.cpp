#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "tests/e2e/program.h"

using namespace faba;

TEST_CASE("run: files, JSON fields, same hash for any number of threads and for a repeated run") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  const Called a = faba_in(f.path, "run s.toml --seed 5 --out a --json --threads 1");
  REQUIRE_MESSAGE(a.exit == 0, a.err);
  CHECK(a.err.empty());
  const auto j = a.json();
  CHECK(j["out"] == "a");
  CHECK(j["seed"] == 5);
  CHECK(j["frames"] == 30);
  CHECK(j["dispersion_px"].size() == 2);
  CHECK(j.contains("settling_time_s"));
  CHECK(j.contains("steady_rms_px"));
  for (const char* name :
       {"manifest.json", "scenario.toml", "series.csv", "tracks.h5", "video.mp4", "report.html"})
    CHECK_MESSAGE(std::filesystem::exists(f.path / "a" / name), name);
  CHECK_FALSE(std::filesystem::exists(f.path / "a/incomplete"));
  const std::string page = read_file(f.path / "a/report.html");
  std::size_t frames = 0;  // six, from 0 s to the last of 30 frames at 15 Hz
  for (std::size_t at = 0; (at = page.find("alt=\"Frame at ", at)) != std::string::npos; ++at) ++frames;
  CHECK(frames == 6);
  CHECK(page.find("Frame at 0 s") != std::string::npos);
  CHECK(page.find("Frame at 1.93 s") != std::string::npos);
  CHECK(nlohmann::json::parse(read_file(f.path / "a/manifest.json"))["state_hash"] == j["state_hash"]);
  const std::string series = read_file(f.path / "a/series.csv");
  CHECK(series.starts_with(
      "frame,t_s,true_centroid_x_px,true_centroid_y_px,true_sigma_x_px,true_sigma_y_px,true_rms_radius_px,"
      "estimated_centroid_x_px,estimated_centroid_y_px,estimated_sigma_x_px,estimated_sigma_y_px,distance_"
      "px,"));
  REQUIRE(faba_in(f.path, "run s.toml --seed 5 --out b --quiet --set record.flow=true").exit == 0);
  CHECK(std::filesystem::exists(f.path / "b/flow.h5"));
  REQUIRE(faba_in(f.path, "run s.toml --seed 5 --out b --quiet --force").exit == 0);
  CHECK_FALSE(std::filesystem::exists(f.path / "b/flow.h5"));  // the file of the replaced run is deleted
  for (const char* more : {"--threads 2", "--threads 3", ""})
    CHECK(faba_in(f.path, std::string("run s.toml --seed 5 --force --out b --json ") + more)
              .json()["state_hash"] == j["state_hash"]);
  CHECK(faba_in(f.path, "run a/scenario.toml --out c --json").json()["state_hash"] == j["state_hash"]);
  CHECK(faba_in(f.path, "run s.toml --seed 6 --out d --json").json()["state_hash"] != j["state_hash"]);
}

TEST_CASE("pages are equal byte by byte for any number of threads, output folder and date") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  for (const char* how : {"--threads 1 --out a", "--threads 2 --out other/b"})
    REQUIRE(faba_in(f.path, std::string("run s.toml --seed 5 --as-seen --quiet ") + how).exit == 0);
  CHECK(read_file(f.path / "a/report.html") == read_file(f.path / "other/b/report.html"));
  CHECK(read_file(f.path / "a/report.html").find("poster=\"data:image/png") != std::string::npos);
  const auto manifest = nlohmann::json::parse(read_file(f.path / "other/b/manifest.json"));
  CHECK(manifest["out"] == "other/b");
  CHECK(manifest["threads"] == 2);
  CHECK(manifest["date"].get<std::string>().size() == std::string("2026-03-01T12:00:00Z").size());

  for (const std::string verb : {"activity a/video.mp4 --direction 0", "compare a a --no-floor --no-align",
                                 "track a/video.mp4 --size 4"}) {
    std::string pages[2];
    for (int k = 0; k < 2; ++k) {
      const std::string name = k == 0 ? "one.html" : "other/two.html";
      const Called c =
          faba_in(f.path, verb + " --json --force --threads " + std::to_string(k + 1) + " --report " + name);
      REQUIRE_MESSAGE(c.exit == 0, verb << ": " << c.err);
      const auto p = c.json()["provenance"];
      CHECK(p["version"] == manifest["version"]);
      CHECK(p["inputs"][0]["sha256"].get<std::string>().size() == 64);
      CHECK_FALSE(p["options"].contains("--threads"));
      CHECK_FALSE(p["options"].contains("--report"));
      CHECK_FALSE(p["options"].empty());
      pages[k] = read_file(f.path / name);
    }
    CHECK(pages[0] == pages[1]);
    CHECK(pages[0].find("<h2>Provenance</h2>") != std::string::npos);
  }
}

TEST_CASE("a run that ends before its last setpoint is not settled, in the terminal, the page and --json") {
  const TestFolder f;
  write_file(
      f.path / "s.toml",
      "duration = '2 s'\n[arena]\ntype = 'box'\nsize_px = [160, 120]\n[[swarm]]\ncount = 5\n"
      "model = 'basic'\nstart = { type = 'places', places_px = [[80, 60]] }\n[controller]\ntype = 'manual'\n"
      "[reference]\ntype = 'route'\nsetpoints_px = [[80, 60], [20, 20]]\nhold_frames = 1000\n");
  const Called c = faba_in(f.path, "run s.toml --seed 1 --out a --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["settling_time_s"].is_null());
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out b").out.find("not settled") != std::string::npos);
  CHECK(read_file(f.path / "a/report.html").find("<b>not settled</b>") != std::string::npos);
}

TEST_CASE(
    "a route whose first setpoint is reached in the first frame: all setpoints are recorded, and it "
    "settles") {
  const TestFolder f;
  write_file(
      f.path / "s.toml",
      "duration = '4 s'\n[arena]\ntype = 'box'\nsize_px = [160, 120]\n[[swarm]]\ncount = 5\n"
      "model = 'basic'\nstart = { type = 'places', places_px = [[80, 60]] }\n[controller]\ntype = 'fuzzy'\n"
      "[reference]\ntype = 'route'\nsetpoints_px = [[80, 60], [85, 62]]\nhold_frames = 1\n");
  const Called c = faba_in(f.path, "run s.toml --seed 1 --out a --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["setpoints"] == 2);
  CHECK(c.json()["setpoints_reached"] == 2);
  CHECK(c.json()["settling_time_s"].is_number());
}

TEST_CASE("run: a random seed is printed and recorded, and repeats the run") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  const auto first = faba_in(f.path, "run s.toml --out a --json").json();
  const auto again = faba_in(f.path, "run s.toml --out b --json --seed " + first["seed"].dump()).json();
  CHECK(again["state_hash"] == first["state_hash"]);
  CHECK(faba_in(f.path, "run s.toml --out c").out.find("(random; --seed ") != std::string::npos);
}

TEST_CASE("run: the tracks open in h5py with fps and um_per_px") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 5 --out a --quiet").exit == 0);
  write_file(f.path / "read.py",
             "import h5py\nf = h5py.File('a/tracks.h5')\n"
             "print(f['position_px'].shape, f.attrs['fps'], round(f.attrs['um_per_px'], 4), f['t_s'][1])\n");
  const std::string command = "cd '" + f.path.string() + "' && /usr/bin/python3 read.py > out.txt 2>&1";
  CHECK(std::system(command.c_str()) == 0);
  CHECK(read_file(f.path / "out.txt") == "(30, 50, 2) 15.0 0.9164 0.06666666666666667\n");
}

TEST_CASE("run: the origin of the scale is in the manifest; a simulated camera has a scale") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  const auto j = faba_in(f.path, "run s.toml --seed 1 --json --out a").json();
  CHECK(j["um_per_px"].is_number());
  CHECK(j["um_per_px_source"].is_null());
  CHECK(j["warnings"].empty());
  const auto typed =
      faba_in(f.path, "run s.toml --seed 1 --json --out b --as-seen --set scale.um_per_px=1.5").json();
  CHECK(typed["um_per_px_source"] == "typed");
  const auto tracked = faba_in(f.path, "track b --json").json();
  CHECK(tracked["um_per_px"] == 1.5);
  CHECK(tracked["um_per_px_source"] == "typed");
  const auto nominal =
      faba_in(f.path, "run s.toml --seed 1 --json --out c --as-seen --set scale.nominal_um_per_px=1.5")
          .json();
  CHECK(nominal["um_per_px"].is_null());
  CHECK(nominal["warnings"][0]["aspect"] == "scale");
  CHECK(nominal["state_hash"] == typed["state_hash"]);
  CHECK(faba_in(f.path, "track c --json").json()["um_per_px"].is_null());
}

TEST_CASE("run --as-seen: the videos have camera frames, and the run records this") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene + "[record]\nlossless = true\n");
  const Called drawn = faba_in(f.path, "run s.toml --seed 5 --out a --json");
  const Called seen = faba_in(f.path, "run s.toml --seed 5 --out b --json --as-seen");
  REQUIRE_MESSAGE(seen.exit == 0, seen.err);
  CHECK(seen.json()["video_shows"] == "camera");
  CHECK(drawn.json()["video_shows"] == "drawing");
  CHECK(seen.json()["state_hash"] == drawn.json()["state_hash"]);
  CHECK(read_file(f.path / "a/video.mp4") != read_file(f.path / "b/video.mp4"));
  CHECK(read_file(f.path / "b/scenario.toml").find("[microscope]") != std::string::npos);
  CHECK(faba_in(f.path, "run b/scenario.toml --out c --json").json()["video_shows"] == "camera");
  CHECK(read_file(f.path / "c/video.avi") == read_file(f.path / "b/video.avi"));

  const Called wrong = faba_in(f.path, "run s.toml --as-seen --set microscope.exposure_time='1 s'");
  CHECK(wrong.exit == 2);
  CHECK(one_clear_line(wrong.err));
  const Called blind = faba_in(f.path, "run s.toml --set camera.sensor=frames --set estimator=visible");
  CHECK(blind.exit == 2);
  CHECK(one_clear_line(blind.err));
  const Called absent = faba_in(f.path, "run s.toml --as-seen --set microscope.background=none.avi");
  CHECK(absent.exit == 3);
  CHECK(one_clear_line(absent.err));
  const Called idle = faba_in(f.path, "run s.toml --out d --set microscope.contrast=-0.2");
  CHECK(idle.exit == 0);
  CHECK(idle.err.find("microscope: has no effect") != std::string::npos);
}

TEST_CASE("Ctrl-C: exit 130, the recording is readable, resume gives the same hash") {
  const TestFolder f;

  const std::string scene =
      "duration = '100 s'\nexclusion = { order = 'none' }\n[[swarm]]\ncount = 4000\nmodel = 'basic'\n"
      "[record]\nvideo = false\ntracks_every = 50\ncheckpoint = '0.2 s'\n";
  write_file(f.path / "s.toml", scene);
  const auto uninterrupted = faba_in(f.path, "run s.toml --seed 1 --out uninterrupted --json").json();
  // The signal is sent when a part of the run is on the disk, independent of the speed of the machine.
  const std::string command = "cd '" + f.path.string() +
                              "' && { '" FABA_PROGRAM "' run s.toml --seed 1 --quiet --out cut & pid=$!; " +
                              "until [ $(cat cut/series.csv 2> /dev/null | wc -c) -gt 400 ] || ! kill -0 "
                              "$pid; do sleep 0.02; done; " +
                              "kill -INT $pid; wait $pid; }";
  const int status = std::system(command.c_str());
  if (status == 0) return;  // the run was complete before the signal
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(std::filesystem::exists(f.path / "cut/incomplete"));
  CHECK(read_file(f.path / "cut/series.csv").size() > 200);
  const Called again = faba_in(f.path, "run s.toml --seed 1 --out cut");
  CHECK(again.exit == 2);
  CHECK(again.err.find("continue it with `faba resume`") != std::string::npos);
  const Called resumed = faba_in(f.path, "resume cut --json");
  REQUIRE_MESSAGE(resumed.exit == 0, resumed.err);
  CHECK(resumed.json()["state_hash"] == uninterrupted["state_hash"]);
  CHECK(read_file(f.path / "cut/series.csv") == read_file(f.path / "uninterrupted/series.csv"));
}

TEST_CASE("setpoints_reached counts the setpoints that the swarm reached, setpoints those of the scenario") {
  const TestFolder f;
  const std::string run = "run '" FABA_SCENES "/steer.toml' --seed 1 --json --set record.video=false ";
  const Called on = faba_in(f.path, run + "--out on");
  REQUIRE_MESSAGE(on.exit == 0, on.err);
  CHECK(on.json()["setpoints"] == 4);
  CHECK(on.json()["setpoints_reached"] == 4);
  CHECK(read_file(f.path / "on/report.html").find("Setpoints reached") != std::string::npos);
  const Called off = faba_in(f.path, run + "--out off --set 'controller={type=\"manual\"}'");
  REQUIRE_MESSAGE(off.exit == 0, off.err);
  CHECK(off.json()["setpoints"] == 4);
  CHECK(off.json()["setpoints_reached"] == 0);
  // With a timeout the route continues although the swarm does not reach a setpoint.
  const Called late = faba_in(f.path, run +
                                          "--out late --set 'controller={type=\"manual\"}' "
                                          "--set 'reference.timeout=\"1 s\"'");
  REQUIRE_MESSAGE(late.exit == 0, late.err);
  CHECK(late.json()["setpoints_reached"] == 0);
}

TEST_CASE("kill -9 at any time: resume gives the same hash, series and video") {
  const TestFolder f;
  write_file(f.path / "s.toml",
             "duration = '75 s'\nexclusion = { order = 'none' }\n[[swarm]]\ncount = 4000\nmodel = 'basic'\n"
             "[record]\nvideo_every = 30\ntracks_every = 50\ncheckpoint = '0.1 s'\n");
  const auto uninterrupted = faba_in(f.path, "run s.toml --seed 1 --out uninterrupted --json").json();
  for (int kill = 1; kill <= 6; ++kill) {
    const std::string dir = "cut" + std::to_string(kill);
    const std::string after = std::to_string(0.05 + 0.1 * kill);
    Called c = faba_in(f.path, "run s.toml --seed 1 --quiet --out " + dir, "timeout -s KILL " + after);
    for (int i = 0; i < 3 && std::filesystem::exists(f.path / dir / "incomplete");
         ++i)  // also killed during resume
      c = faba_in(f.path, "resume " + dir + " --quiet", "timeout -s KILL " + after);
    if (std::filesystem::exists(f.path / dir / "incomplete"))
      c = faba_in(f.path, "resume " + dir + " --json");
    if (!std::filesystem::exists(f.path / dir / "manifest.json"))
      continue;  // killed before the directory was created
    INFO("killed after ", after, " s: ", c.err);
    CHECK(nlohmann::json::parse(read_file(f.path / dir / "manifest.json"))["state_hash"] ==
          uninterrupted["state_hash"]);
    CHECK(read_file(f.path / dir / "series.csv") == read_file(f.path / "uninterrupted/series.csv"));
    CHECK(read_file(f.path / dir / "video.mp4") == read_file(f.path / "uninterrupted/video.mp4"));
  }
}
