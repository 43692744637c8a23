// `faba optics`: output, and messages for invalid input.
#include <doctest/doctest.h>

#include "tests/e2e/program.h"

using namespace faba;

TEST_CASE("optics: the setup of the thesis, as text and as JSON") {
  const TestFolder f;
  const Called c = faba_in(f.path, "optics");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.out.find("view          513 x 385 um") != std::string::npos);
  CHECK(c.out.find("Formation of a swarm          good") != std::string::npos);
  const auto j = faba_in(f.path, "optics --json").json();
  CHECK(j["um_per_px"].get<double>() == doctest::Approx(0.8015));
  CHECK(j["verdicts"].size() == 5);
  for (const auto& v : j["verdicts"])
    for (const char* key : {"measurement", "title", "evidence", "quality", "warnings"})
      CHECK(v.contains(key));
  CHECK(j["provenance"]["options"].empty());
}

TEST_CASE("optics: options override those of the objective") {
  const TestFolder f;
  const auto j =
      faba_in(f.path,
              "optics --objective 100x --numerical-aperture 0.7 --speed '93 um/s' --frame-rate 30 --json")
          .json();
  CHECK(j["setup"]["magnification"] == 100);
  CHECK(j["setup"]["numerical_aperture"] == 0.7);
  CHECK(j["view_um"][0].get<double>() == doctest::Approx(51.296));
  CHECK(j["displacement_px"].get<double>() == doctest::Approx(93 / 30.0 / 0.08015));
}

TEST_CASE("optics: invalid values are refused with the option and what is permitted") {
  const TestFolder f;
  for (const auto& [options, part] : {std::pair{"--speed 186", "--speed"},
                                      {"--speed '1 kg'", "--speed"},
                                      {"--objective 7x", "--objective"},
                                      {"--frame-rate '100 Hz' --exposure-time '11 ms'", "frame period"},
                                      {"--um-per-px 1 --pixel-size '7 um'", "two ways"},
                                      {"--width-px 3.5", "--width-px"}}) {
    const Called c = faba_in(f.path, std::string("optics ") + options);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
    CHECK_MESSAGE(c.err.find(part) != std::string::npos, c.err);
  }
}
