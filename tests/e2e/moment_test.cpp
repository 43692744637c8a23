// `faba moment`: rendered cells whose field reverses, and wrong study files.
#include <doctest/doctest.h>

#include <cmath>

#include "core/file.h"
#include "tests/e2e/program.h"

using namespace faba;

TEST_CASE("moment: the moment of rendered cells is inside the interval, without a scale") {
  const TestFolder f;
  write_file(f.path / "s.toml",
             "duration = '2.4 s'\n[camera]\nrate = '60 Hz'\n[arena]\ntype = 'box'\nsize_px = [420, 320]\n"
             "[[swarm]]\ncount = 40\nstart = { type = 'uniform' }\n"
             "model = { type = 'dipole', moment = 1e-15, speed = '80 um/s', speed_sd = '15 um/s' }\n"
             "[record]\nas_seen = true\nlossless = true\nvideo = false\ntracks = false\n"
             "[controller]\ntype = 'manual'\nfield = ['0.1 mT', '0 T']\n"
             "[[controller.segment]]\nat = '0.8 s'\nfield = ['-0.1 mT', '0 T']\n"
             "[[controller.segment]]\nat = '1.6 s'\nfield = ['0.1 mT', '0 T']\n");
  REQUIRE(faba_in(f.path, "run s.toml --seed 2 --out run -q").exit == 0);
  const std::string video = "[[video]]\nfile = 'run'\nfield = '0.1 mT'\n";
  write_file(f.path / "m.toml", "[cell]\nradius = '0.7 um'\n" + video + "reversals = ['0.8 s', '1.6 s']\n");
  const Called c = faba_in(f.path, "moment m.toml --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  CHECK(j["moment_am2"]["ci90"][0].get<double>() < 1e-15);
  CHECK(j["moment_am2"]["ci90"][1].get<double>() > 1e-15);
  // kappa = 24: 30 turns give the median to 1.25 / sqrt(24 * 30) = 5 %, the size to 15 %; 4 standard errors.
  CHECK(std::fabs(std::log(j["moment_am2"]["median"].get<double>() / 1e-15)) < 4 * 0.05);
  CHECK(j["turns"].get<int>() >= 30);
  CHECK(j["videos"][0]["rate_per_t_per_s"]["median"] == j["rate_per_t_per_s"]["median"]);
  CHECK(j["quality"] != "poor");
  for (const auto& [text, exit, message] :
       {std::tuple<std::string, int, std::string>{video, 2, "reversals = [\"2 s\"]"},
        {video + "reversals = ['2 s', '1 s']\n", 2, "ascending"},
        {"[[video]]\nfile = 'none.avi'\nfield = '1 mT'\nreversals = ['1 s']\n", 3, "none.avi"},
        {"[cell]\nlength = '2 um'\n" + video + "reversals = ['1 s']\n", 2, "length and width"},
        {"[cell]\nradius = '1 um'\n", 2, "[[video]] is missing"}}) {
    write_file(f.path / "bad.toml", text);
    const Called bad = faba_in(f.path, "moment bad.toml");
    INFO(bad.err);
    CHECK(bad.exit == exit);
    CHECK(one_clear_line(bad.err));
    CHECK(bad.err.find(message) != std::string::npos);
  }
}
