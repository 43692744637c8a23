// faba flow, activity, compare and distance: files, notes and error messages.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "core/file.h"
#include "core/table.h"
#include "tests/app/run_directory.h"
#include "tests/e2e/refused.h"
#include "tests/vision/raw_files.h"

using namespace faba;

namespace {

/// A greyscale PGM picture with a bright spot at (x, y).
std::string spot(int width, int height, double x, double y, double grey = 120) {
  std::string out = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c)
      out += char(std::lround(60 + grey * std::exp(-((c - x) * (c - x) + (r - y) * (r - y)) / 18)));
  return out;
}

/// A folder of frames at 15 Hz in which a spot moves to the right for a second and back.
void write_film(const TestFolder& f, const std::string& name, int frames = 30) {
  std::filesystem::create_directories(f.path / name);
  for (int k = 0; k < frames; ++k) {
    const double x = 12 + (k < frames / 2 ? k : frames - k);
    char file[32];
    std::snprintf(file, sizeof file, "/f%03d.pgm", k);
    write_file(f.path / (name + file), spot(48, 36, x, 17));
  }
}

}  // namespace

TEST_CASE("flow of two pictures: flow file, picture, comparison with the truth, and refused input") {
  const TestFolder f;
  write_file(f.path / "a.pgm", spot(40, 30, 18, 15));
  write_file(f.path / "b.pgm", spot(40, 30, 18.5, 14.75));
  const Called c = faba_in(f.path, "flow a.pgm b.pgm --out ab.flo --picture ab.png --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["image_size"] == nlohmann::json{40, 30});
  CHECK(c.json()["converged"] == true);
  CHECK(std::filesystem::file_size(f.path / "ab.flo") == 12 + 8 * 40 * 30);
  CHECK(read_file(f.path / "ab.png").substr(1, 3) == "PNG");
  CHECK(faba_in(f.path, "flow a.pgm b.pgm --truth ab.flo --json").json()["truth"]["endpoint_px"] == 0);
  const Called two = faba_in(f.path, "flow a.pgm b.pgm --threads 2 --out two.flo");
  CHECK(two.exit == 0);
  CHECK(read_file(f.path / "two.flo") == read_file(f.path / "ab.flo"));

  refused(f, "flow a.pgm b.pgm --out ab.flo", 2, "already exists");
  refused(f, "flow a.pgm b.pgm --out a.pgm --force", 2, "the file extension must be .flo");
  refused(f, "flow a.pgm none.pgm", 3, "file not found");
  refused(f, "flow a.pgm b.pgm --alpha2 0", 2, "out of range");
  refused(f, "flow a.pgm b.pgm --solver gauss", 2, "solver");
  refused(f, "flow a.pgm b.pgm --warps 3", 2, "--warps: has an effect only with --pyramid");
  CHECK(faba_in(f.path, "flow a.pgm b.pgm --warps 3 --pyramid").exit == 0);
  write_file(f.path / "text.pgm", "not a picture");
  refused(f, "flow text.pgm b.pgm", 3, "it is damaged, or of a format that is not supported");
  refused(f, "flow a.pgm b.pgm --quality fast", 2, "not a parameter of method horn_schunck");
  refused(f, "flow a.pgm b.pgm --overlay o.mp4", 2, "--picture");
  refused(f, "flow a.pgm", 3, "one frame only");
  write_file(f.path / "c.pgm", spot(41, 30, 18, 15));
  refused(f, "flow a.pgm c.pgm", 3, "the same size");
  write_file(f.path / "t.flo", "no flow");
  refused(f, "flow a.pgm b.pgm --truth t.flo", 3, "not a flow in the Middlebury format");
  CHECK_FALSE(std::filesystem::exists(f.path / "o.mp4"));
}

TEST_CASE("flow, activity and compare give the same for a folder of frames and for its flow file") {
  const TestFolder f;
  write_film(f, "film");
  REQUIRE(faba_in(f.path, "flow film --preset published --out film.h5 --overlay o.mp4 --quiet").exit == 0);
  CHECK(std::filesystem::exists(f.path / "o.mp4"));
  CHECK_FALSE(std::filesystem::exists(f.path / "film.h5.part"));
  const auto a = faba_in(f.path, "activity film --json --flow-threshold 0.05").json();
  const auto b = faba_in(f.path, "activity film.h5 --json --flow-threshold 0.05").json();
  CHECK(a["videos"][0]["mean_activity"] == b["videos"][0]["mean_activity"]);
  const Called c = faba_in(f.path, "compare film film.h5 --json --no-align --flow-threshold 0.05");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["runs"][0]["mean"] == 0);
  CHECK(c.json()["floor"].is_null());
  CHECK(c.json()["naive"].get<double>() > 0);
  refused(f, "activity film.h5 --picture p.png --flow-threshold 0.05", 3, "the video");
  refused(f, "compare film none", 3, "file not found");
}

TEST_CASE(
    "black frames, identical frames, one frame and frames of different size: a result or one clear line") {
  const TestFolder f;
  for (const char* name : {"black", "still", "mixed"}) std::filesystem::create_directories(f.path / name);
  for (int k = 0; k < 12; ++k) {
    const std::string file = "/" + std::to_string(k) + ".pgm";
    write_file(f.path / ("black" + file), "P5 32 24 255\n" + std::string(32 * 24, '\0'));
    write_file(f.path / ("still" + file), spot(32, 24, 15, 11));
    write_file(f.path / ("mixed" + file), spot(k < 8 ? 32 : 30, 24, 15, 11));
  }
  for (const char* name : {"black", "still"}) {
    const Called c = faba_in(f.path, std::string("activity ") + name + " --json");
    REQUIRE_MESSAGE(c.exit == 0, c.err);
    CHECK(c.json()["videos"][0]["segments"].empty());
    CHECK(c.json()["videos"][0]["gaussian"]["good"] == false);
    CHECK(c.json()["videos"][0]["responds"] == false);
  }
  refused(f, "activity mixed", 3, "size");
  refused(f, "flow mixed --out m.h5", 3, "size");
  CHECK_FALSE(std::filesystem::exists(f.path / "m.h5"));
  CHECK_FALSE(std::filesystem::exists(f.path / "m.h5.part"));
  write_file(f.path / "one.pgm", spot(32, 24, 15, 11));
  refused(f, "activity one.pgm", 3, "one frame only");
}

TEST_CASE("a truncated video is measured up to its end, with a warning; an unknown codec is reported") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --out r --as-seen --quiet --set record.lossless=true").exit ==
          0);
  const Called other_rate = faba_in(f.path, "track r --fps 30 --um-per-px 2");
  CHECK(other_rate.err.find("the run states 15 Hz and ") != std::string::npos);
  CHECK(other_rate.err.find("30 Hz and 2 um/px are used (--fps, --um-per-px)") != std::string::npos);
  CHECK(faba_in(f.path, "track r --fps 15").err.find("the run states") == std::string::npos);
  CHECK(faba_in(f.path, "activity r --fps 30").err.find("the run states 15 Hz; 30 Hz is used (--fps)") !=
        std::string::npos);
  const std::string complete = read_file(f.path / "r/video.avi");
  write_file(f.path / "cut.avi", complete.substr(0, complete.size() * 6 / 10));
  for (const char* verb : {"activity cut.avi", "compare r/video.avi cut.avi --no-align",
                           "flow cut.avi --out cut.h5", "track cut.avi"}) {
    const Called c = faba_in(f.path, verb);
    CAPTURE(verb);
    CHECK_MESSAGE(c.exit == 0, c.err);
    CHECK(c.err.find("frames could be read; the file is truncated") != std::string::npos);
  }
  const auto pairs = [&](const char* video) {
    return faba_in(f.path, std::string("activity --json ") + video).json()["videos"][0]["pairs"].get<int>();
  };
  CHECK(pairs("cut.avi") > 5);
  CHECK(pairs("cut.avi") < pairs("r/video.avi"));

  std::string odd = complete;
  for (std::size_t at; (at = odd.find("MPNG")) != std::string::npos;) odd.replace(at, 4, "ZZZZ");
  write_file(f.path / "odd.avi", odd);
  for (const char* verb :
       {"activity odd.avi", "compare r/video.avi odd.avi", "flow odd.avi --out o.h5", "track odd.avi"})
    refused(f, verb, 3, "odd.avi: codec not supported");
}

TEST_CASE("invalid numbers, outputs and times are refused before any measurement") {
  const TestFolder f;
  write_film(f, "film");
  refused(f, "activity film --direction nan", 2, "out of range");
  refused(f, "activity film --flow-threshold -1", 2, "must be between 0 and");
  refused(f, "activity film --fps nan", 2, "--fps");
  refused(f, "compare film film --t0 nan", 2, "--t0");
  refused(f, "compare film film --t0 0.1 --no-align", 2, "--no-align");
  refused(f, "activity film --noise film --flow-threshold 0.1", 2,
          "--flow-threshold and --noise cannot be combined; give only one of them");
  refused(f, "activity film --noise film", 2, "--noise: film is the measured video itself");
  refused(f, "activity film --report none/r.html", 2, "folder none not found");
  refused(f, "track film --fps 15 --out a.csv --swarm a.csv", 2, "two outputs");
  refused(
      f, "activity film --from 100", 3,
      "has fewer than two frames from frame 100 to the end; the video ends at frame 29; change the interval");
  refused(f, "activity film --fps 10 --from 5 --to 6", 3,
          "has fewer than two frames from 5 s to 6 s; the video ends at 2.9 s; change the interval");
  CHECK_FALSE(std::filesystem::exists(f.path / "a.csv"));
}

TEST_CASE("a part of a video is measured with --from and --to, at the rate of --fps") {
  const TestFolder f;
  write_film(f, "film");
  const Called untimed = faba_in(f.path, "activity film --flow-threshold 0.05 --out all.csv --force");
  CHECK(untimed.err.find("no frame rate is stated") != std::string::npos);
  CHECK(untimed.out.find("  frame ") != std::string::npos);
  CHECK(untimed.out.find(" s  direction") == std::string::npos);
  REQUIRE(faba_in(f.path, "activity film --flow-threshold 0.05 --report untimed.html --quiet").exit == 0);
  CHECK(read_file(f.path / "untimed.html").find("time (frames)") != std::string::npos);
  CHECK(read_file(f.path / "untimed.html").find("onset (frames)") != std::string::npos);
  CHECK(faba_in(f.path, "flow film").out.starts_with("29 pairs in 30 frames, "));
  CHECK(faba_in(f.path, "flow film --fps 10").out.starts_with("29 pairs of frames in 2.9 s, "));
  const Called longer = faba_in(
      f.path, "compare film film --fps 15 --no-align --duration 100 --direction 0 --flow-threshold 0.05");
  CHECK(longer.err.find("the comparison ends after 1.93 s") != std::string::npos);
  CHECK(longer.out.find("not computed: none of the compared inputs is a run") != std::string::npos);
  REQUIRE(
      faba_in(f.path,
              "activity film --fps 15 --from 0.5 --to \"1.5 s\" --flow-threshold 0.05 --out part.csv --quiet")
          .exit == 0);
  const Table all = read_table(f.path / "all.csv"), part = read_table(f.path / "part.csv");
  CHECK(all.size() == 29);
  CHECK(all.column("t1_s")[28] == 29);
  REQUIRE(part.size() > 10);
  CHECK(part.column("t0_s")[0] >= 0.5);
  CHECK(part.column("t1_s")[part.size() - 1] <= 1.5);
  const auto first = std::size_t(std::lround(part.column("t0_s")[0] * 15));
  CHECK(part.column("activity")[0] == all.column("activity")[first]);
}

TEST_CASE("a single moving spot is tracked, and its speed is reported") {
  const TestFolder f;
  std::filesystem::create_directories(f.path / "dot");
  for (int k = 0; k < 10; ++k)
    write_file(f.path / ("dot/f" + std::to_string(k) + ".pgm"), spot(64, 48, 12 + 3 * k, 20));
  const Called c = faba_in(f.path, "track dot --fps 10 --swarm s.csv");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.out.find("speed    mean 30 px/s") != std::string::npos);
  const Table t = read_table(f.path / "s.csv");
  for (std::size_t k = 0; k < 10; ++k)
    CHECK(t.column("x_px")[k] == doctest::Approx(12 + 3 * double(k)).epsilon(0.02));
}

TEST_CASE("with a variable frame rate the times of the frames are used, not their indices") {
  const TestFolder f;
  write_file(f.path / "v.gif", media::gif_file(32, 24, {{20, 10}, {60, 30}, {100, 5}, {140, 20}}));
  REQUIRE(faba_in(f.path, "activity v.gif --out v.csv --flow-threshold 0.1 --quiet").exit == 0);
  const Table t = read_table(f.path / "v.csv");
  const double ends[] = {0, 0.10, 0.40, 0.45};
  REQUIRE(t.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(t.column("t0_s")[k] == doctest::Approx(ends[k]));
    CHECK(t.column("t1_s")[k] == doctest::Approx(ends[k + 1]));
  }
  const Called c = faba_in(f.path, "compare v.gif v.gif --no-align --json --flow-threshold 0.1");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["runs"][0]["mean"] == 0);
}

TEST_CASE("a drawn video of a run is not measured, but the recorded flow of a run is") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --out drawn --quiet").exit == 0);
  refused(f, "activity drawn", 3, "drawing");
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --out flows --quiet --set record.flow=true").exit == 0);
  CHECK(std::filesystem::exists(f.path / "flows/flow.h5"));
  const Called c = faba_in(f.path, "activity flows --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["videos"][0]["pairs"] == 29);  // two seconds at 15 Hz
  const Called d = faba_in(f.path, "compare flows flows --json --no-align");
  REQUIRE_MESSAGE(d.exit == 0, d.err);
  CHECK(d.json()["runs"][0]["mean"] == 0);
}

TEST_CASE("results are the same for any number of threads") {
  const TestFolder f;
  write_film(f, "film");
  write_film(f, "other", 24);
  const auto same = [&](const std::string& verb, const std::string& out) {
    CAPTURE(verb);
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
      const Called c = faba_in(f.path, verb + " --fps 15 --json --force --threads " + threads +
                                           (out.empty() ? "" : " --out " + out));
      REQUIRE_MESSAGE(c.exit == 0, c.err);
      const std::string all = c.out + (out.empty() ? "" : read_file(f.path / out));
      if (first.empty()) first = all;
      CHECK(all == first);
    }
  };
  same("activity film", "a.csv");
  same("activity film other --flow-threshold 0.1", "a.csv");
  same("compare film other --no-align", "c.csv");
  same("flow film", "f.h5");
  same("track film --size 7 --polarity bright", "t.csv");
}

TEST_CASE("a part of a video: the same flows as in the complete video, without reading the rest") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --out run --quiet --as-seen").exit == 0);
  REQUIRE(faba_in(f.path, "activity run --direction 0 --flow-threshold 0.1 --out all.csv").exit == 0);
  REQUIRE(faba_in(f.path,
                  "activity run --direction 0 --flow-threshold 0.1 --from '0.5 s' --to 1.2 --out part.csv")
              .exit == 0);
  const Table all = read_table(f.path / "all.csv"), part = read_table(f.path / "part.csv");
  const auto t0 = all.column("t0_s"), t1 = all.column("t1_s");
  std::size_t k = 0;
  for (std::size_t i = 0; i < t0.size(); ++i) {
    if (t0[i] < 0.5 || t1[i] > 1.2) continue;
    REQUIRE(k < part.size());
    for (const std::string& name : all.names()) CHECK(part.column(name)[k] == all.column(name)[i]);
    ++k;
  }
  CHECK(k == part.size());
  CHECK(k >= 9);
  const Called flow = faba_in(f.path, "flow run --from 0.5 --to '1200 ms' --json");
  CHECK(flow.json()["pairs"] == k);
  refused(f, "flow run --from 2 --to 1", 2,
          "the time from 2 s to 1 s is empty; --to must be later than --from");
  refused(f, "flow run --from 100", 3,
          "has fewer than two frames from 100 s to the end; the video ends at 1.93333 s");
  refused(f, "compare run run --from 0.1 --to 0.11", 3, "has fewer than two frames from 0.1 s to 0.11 s");
  refused(f, "track run --from 100", 3, "has no frames from 100 s to its end");
  refused(f, "flow s.toml s.toml --from 1", 2, "--from: requires a video");
  const Called track = faba_in(f.path, "track run --from 0.5 --to 1.2 --out t.csv --size 4");
  REQUIRE_MESSAGE(track.exit == 0, track.err);
}

TEST_CASE("study files and distances: errors name the file, the key or the line") {
  const TestFolder f;
  write_file(f.path / "none.toml", "direction = 0\n");
  refused(f, "activity none.toml", 2, "[[video]] is missing; give one for each video");
  write_file(f.path / "typo.toml", "[[video]]\nfile = 'a.avi'\nexposur = '100 s'\n");
  refused(f, "activity typo.toml", 2, "exposure");
  write_file(f.path / "gone.toml", "[[video]]\nfile = 'a.avi'\nexposure = '100 s'\n");
  refused(f, "activity gone.toml", 3,
          "gone.toml:2: video[0].file: file not found: a.avi (relative to the study file)");
  write_file(f.path / "noise.toml", "noise = 'n.avi'\n[[video]]\nfile = 'noise.toml'\n");
  refused(f, "activity noise.toml", 3, "noise.toml:1: noise: file not found: n.avi");

  write_file(f.path / "p", "1\n0\n2\n3\n0\n0\n");
  write_file(f.path / "q", "0\n1\n2\n5\n0\n0\n");
  const Called c = faba_in(f.path, "distance p q q");
  CHECK(c.out.substr(0, 8) == "0.403214");
  CHECK(std::count(c.out.begin(), c.out.end(), '\n') == 2);
  write_file(f.path / "words", "1\nmany\n");
  refused(f, "distance p words", 3, "words:2");
  refused(f, "distance p words", 3, "\"many\" is not a number; write one number per line");
  write_file(f.path / "short", "1\n2\n");
  refused(f, "distance p short", 3, "has 2 bins");
  write_file(f.path / "below", "1\n-2\n");
  refused(f, "distance below p", 3, "at least 0");
  refused(f, "distance p q --m 1", 2, "less than 1");
  refused(f, "distance p q --threshold 0", 2, "above 0");
}
