// Which nuisance parameters a study frees by default.
#include "study/identify/families/nuisances.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "study/identify/identify_study.h"
#include "study/identify/parameter_search.h"
#include "tests/app/run_directory.h"

using namespace faba;

namespace {

const std::string kFilm = "boundary = \"box\"\nfield_strength = \"100 uT\"\n[[video]]\nfile = \"film.avi\"\n";
const std::string kSpeed = "free = { \"swarm[0].model.speed\" = [\"20 um/s\", \"200 um/s\"] }\n";

IdentifyStudy study(const std::string& text) {
  const TestFolder f;
  write_file(f.path / "film.avi", "");  // only its existence is checked
  write_file(f.path / "study.toml", text);
  return read_identify_study(f.path / "study.toml");
}

std::vector<std::string> nuisances(const IdentifyStudy& s) {
  std::vector<std::string> paths;
  for (const FreeParameter& p : s.candidates.front().free)
    if (p.nuisance()) paths.push_back(p.path);
  return paths;
}

using Paths = std::vector<std::string>;

}  // namespace

TEST_CASE(
    "nuisances: motile and responsive fraction and spread of the speed of a dipole, with enough "
    "simulations") {
  const IdentifyStudy s = study("simulations = 100\n" + kFilm + "[[model]]\ntype = \"dipole\"\n" + kSpeed);
  CHECK(nuisances(s) == Paths{"swarm[0].model.motile", "swarm[0].responding", "swarm[0].model.speed_sd"});
  const Candidate& c = s.candidates.front();
  CHECK(c.free.front().path == "swarm[0].model.speed");
  CHECK(c.free.back().high == doctest::Approx(50e-6));  // a quarter of the largest speed
  CHECK(c.simulations == ParameterSearch::least_simulations(4));
  // Most cells of a culture swim, but any fraction is possible.
  const FreeParameter& motile = c.free[1];
  CHECK(motile.value(0) == 0);
  CHECK(motile.value(1) == 1);
  CHECK(motile.value(0.5) == doctest::Approx(0.881).epsilon(0.001));
  CHECK(motile.fraction(motile.value(0.3)) == doctest::Approx(0.3));
  CHECK(s.count_sd > 0);
}

TEST_CASE("nuisances: not those that the study fixes or frees, nor those without effect") {
  const std::string fixed =
      "[[model]]\ntype = \"dipole\"\nmotile = 1\nset = { \"swarm[0].responding\" = 1 }\n";
  CHECK(nuisances(study("simulations = 200\n" + kFilm + fixed + kSpeed)) == Paths{"swarm[0].model.speed_sd"});
  const std::string basic =
      "[[model]]\ntype = \"basic\"\nfree = { \"swarm[0].model.max_speed\" = [1, 12] }\n";
  CHECK(nuisances(study(kFilm + basic)) == Paths{"swarm[0].responding"});
  const std::string still =
      "[[model]]\ntype = \"dipole\"\nspeed = 0\nspeed_sd = 0\nfield_strength = \"0 T\"\nfree = { "
      "\"swarm[0].model.translational_diffusion\" = [\"0 m^2/s\", \"2e-12 m^2/s\"] }\n";
  CHECK(nuisances(study(kFilm + still)).empty());
  const IdentifyStudy off = study("nuisances = false\n" + kFilm + "[[model]]\ntype = \"dipole\"\n" + kSpeed);
  CHECK(nuisances(off).empty());
  CHECK(off.count_sd == 0);
  CHECK(off.candidates.front().simulations == off.simulations);
}

TEST_CASE("populations: the second swarm has parameters of its own") {
  const std::string two =
      "[[model]]\ntype = \"dipole\"\npopulations = 2\nset = { \"swarm[1].polarity\" = \"north\" }\nfree = { "
      "\"swarm[0].model.speed\" = [\"20 um/s\", \"200 um/s\"], \"swarm[1].model.speed\" = [\"0 um/s\", \"100 "
      "um/s\"] }\n";
  const IdentifyStudy s = study(kFilm + two);
  CHECK(s.candidates.front().free[1].path == "swarm[1].model.speed");
  std::string five = two;
  five.replace(five.find("populations = 2"), 15, "populations = 5");
  CHECK_THROWS_WITH_AS(study(kFilm + five), doctest::Contains("from 1 to 4"), Error);
}

TEST_CASE("uncertainty of the scale: of the study, else of the calibration file") {
  const std::string model = "[[model]]\ntype = \"dipole\"\n" + kSpeed;
  CHECK(study("scale_uncertainty = 0.02\n" + kFilm + model).scale_sd == 0.02);
  CHECK(study("field_uncertainty = 0.1\n" + kFilm + model).field_sd == 0.1);
  CHECK(study(kFilm + model).scale_sd == 0);
  const TestFolder f;
  write_file(f.path / "film.avi", "");
  write_file(f.path / "c.toml", "[scale]\num_per_px = 1\nci95 = [0.902, 1.098]\n");
  write_file(f.path / "study.toml", "scale = \"c.toml\"\n" + kFilm + model);
  CHECK(read_identify_study(f.path / "study.toml").scale_sd == doctest::Approx(0.05));
}
