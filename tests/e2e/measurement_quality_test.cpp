// Every measuring verb ends with its quality and its warnings, in --json and in the terminal. `identify` and
// `moment` have tests of their own.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "tests/e2e/program.h"
#include "tests/rendered_burst.h"
#include "tests/vision/ruler_pictures.h"
#include "vision/files/picture.h"

using namespace faba;

namespace {

// A round drop with a dark edge; `strength` in grey levels.
void write_drop(const std::filesystem::path& file, double strength) {
  Gray8 g(320, 240);
  for (int r = 0; r < g.height; ++r)
    for (int c = 0; c < g.width; ++c) {
      const double depth = (90 - std::hypot(c - 160, r - 120)) / 3;
      g.at(c, r) = std::uint8_t(150 + 5 * ((7 * c + 13 * r) % 3) - strength * std::exp(-depth * depth));
    }
  write_png(file, g);
}

// The JSON has both keys, and the terminal the same word.
nlohmann::json checked(const TestFolder& f, const std::string& command) {
  CAPTURE(command);
  const Called c = faba_in(f.path, command + " --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  REQUIRE(j.contains("quality"));
  REQUIRE(j.contains("warnings"));
  CHECK((j["quality"] == "good" || !j["warnings"].empty()));
  for (const auto& w : j["warnings"])
    for (const char* key : {"aspect", "what", "evidence", "advice"}) CHECK(w[key].is_string());
  const Called text = faba_in(f.path, command);
  CHECK(text.exit == 0);
  const auto at = text.out.find("\nquality ");
  REQUIRE_MESSAGE(at != std::string::npos, text.out);
  CHECK(text.out.substr(at, 40).find(j["quality"].get<std::string>()) != std::string::npos);
  return j;
}

}  // namespace

TEST_CASE("quality and warnings of drop, scale and field fit") {
  const TestFolder f;
  write_drop(f.path / "drop.png", 80);
  CHECK(checked(f, "drop drop.png")["um_per_px"].is_null());
  RulerScene s;
  s.width = 420;
  s.height = 300;
  s.middle = {200, 150};
  write_png(f.path / "ruler.png", stretched(render(s), 0, 1));
  CHECK(checked(f, "scale ruler.png --tick '10 um'")["quality"] == "good");
  // Six readings along the axis do not determine the lateral position.
  write_file(f.path / "coil.toml",
             "[[coil]]\ntype = 'loop'\nradius = '20 mm'\nturns = 50\ncurrent = 2\nposition = [0, 0, 0]\n");
  std::string table = "z_m,bz_t\n";
  for (int i = 0; i < 8; ++i) {
    const double z = 0.005 * i, a = 0.02;
    table += fmt::format("{},{}\n", z, 4e-7 * M_PI * 100 * a * a / 2 / std::pow(a * a + z * z, 1.5));
  }
  write_file(f.path / "scan.csv", table);
  checked(f, "field fit coil.toml --map scan.csv");
}

TEST_CASE("quality and warnings of flow, activity, compare and track") {
  const TestFolder f;
  const Called run = faba_in(f.path, "run '" FABA_SCENES
                                     "/as-seen.toml' --seed 1 --duration '1.6 s' --out run --quiet "
                                     "--set record.lossless=true");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  for (const char* command : {"flow run/video.avi --force --out flow.h5", "activity run",
                              "compare run run --no-floor", "track run"})
    checked(f, command);
}

TEST_CASE("activity: the onset of a response is not before the reversal of the field") {
  const TestFolder f;
  write_file(
      f.path / "s.toml",
      "duration = '4 s'\n[camera]\nrate = '30 Hz'\n[arena]\ntype = 'box'\nsize_px = [400, 200]\n"
      "[scale]\num_per_px = 1\n[[swarm]]\ncount = 150\nmodel = { type = 'dipole', speed = '60 um/s' }\n"
      "start = { type = 'edge', direction = '0 deg' }\n"
      "[controller]\ntype = 'manual'\nfield = ['100 uT', '0 T']\n"
      "[[controller.segment]]\nat = '1 s'\nfield = ['-100 uT', '0 T']\n"
      "[record]\nas_seen = true\nlossless = true\ntracks = false\n");
  REQUIRE(faba_in(f.path, "run s.toml --seed 4 --out run -q").exit == 0);
  const Called c = faba_in(f.path, "activity run --direction 0 --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto video = c.json()["videos"][0];
  CHECK(video["onset_s"].get<double>() >= 1);
  CHECK(video["onset_s"].get<double>() < 1.2);
  REQUIRE(video.contains("onset_ci90"));
  CHECK(video["onset_ci90"][0].get<double>() >= 1);
}

TEST_CASE("activity: a maximum only where something moves in one direction") {
  const TestFolder f;
  write_rendered(burst(60), f.path / "one-way.avi");
  write_rendered(burst(360), f.path / "all-ways.avi");
  const auto maximum = [&](const char* name) {
    const auto video = json_in(f.path, std::string("activity ") + name)["videos"][0];
    CHECK(video["gaussian"]["good"].get<bool>() == video["maximum_s"].is_number());
    return video["maximum_s"];
  };
  const auto one_way = maximum("one-way.avi");
  REQUIRE(one_way.is_number());
  CHECK(std::fabs(one_way.get<double>() - 1.5) < 0.05);
  CHECK(maximum("all-ways.avi").is_null());
  CHECK(faba_in(f.path, "activity all-ways.avi").out.find("maximum at") == std::string::npos);
}

TEST_CASE("track: faint cells in a coded video are not counted several times, or the quality is not good") {
  constexpr int kCells = 150;
  const TestFolder f;
  write_file(f.path / "s.toml",
             "duration = '2 s'\n[camera]\nrate = '15 Hz'\n[arena]\ntype = 'box'\nsize_px = [640, 480]\n"
             "[scale]\num_per_px = 1\n[microscope]\nnoise = 0.0025\ncontrast = -0.08\n"
             "[[swarm]]\ncount = 150\nmodel = { type = 'dipole', speed = '30 um/s' }\n"
             "start = { type = 'uniform' }\n[controller]\ntype = 'manual'\nfield = ['100 uT', '0 T']\n"
             "[record]\nas_seen = true\ntracks = false\n");
  REQUIRE(faba_in(f.path, "run s.toml --seed 4 --out run -q").exit == 0);
  const Called c = faba_in(f.path, "track run/video.mp4 --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  const std::string quality = j.value("quality", "");
  const double spots = j["detection"]["spots_per_frame"];
  CAPTURE(spots);
  CHECK((spots < 1.2 * kCells || quality == "doubtful" || quality == "poor"));
}
