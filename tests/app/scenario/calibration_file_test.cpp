#include "app/scenario/calibration_file.h"
#include "app/scenario/read_scenario.h"

#include <doctest/doctest.h>

#include <string>

#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "tests/app/run_directory.h"

using namespace faba;

namespace {

const std::string kSwarm = "[[swarm]]\ncount = 5\nmodel = 'basic'\n";

std::string refusal_of(const auto& action) {
  try {
    action();
  } catch (const Error& e) {
    CHECK(e.code() == Errc::usage);
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

struct Files {
  TestFolder folder;
  Scenario scenario(const std::string& text) const {
    write_file(folder.path / "scene.toml", text);
    return read_scenario(read_toml(folder.path / "scene.toml"), builtin_parts());
  }
  void calibration(const std::string& text) const { write_file(folder.path / "calibration.toml", text); }
};

}  // namespace

TEST_CASE("a scenario reads its scale from a calibration file and is then self-contained") {
  const Files files;
  files.calibration("[scale]\num_per_px = 1.25\nci95 = [1.2, 1.3]\nmethod = 'm'\nsource = 's'\n");
  const Scenario s = files.scenario("[scale]\nfile = 'calibration.toml'\niteration = '0.1 s'\n" + kSwarm);
  CHECK(s.scale.um_per_px == 1.25);
  CHECK(s.scale.iteration.value() == 0.1);
  const Json resolved = s.resolved();
  CHECK(resolved["scale"]["um_per_px"] == 1.25);
  CHECK_FALSE(resolved["scale"].contains("file"));
  CHECK(s.hash() == files.scenario("[scale]\num_per_px = 1.25\niteration = '0.1 s'\n" + kSwarm).hash());
}

TEST_CASE("invalid calibrations") {
  const Files files;
  const std::string scene = "[scale]\nfile = 'calibration.toml'\n" + kSwarm;
  CHECK(says(refusal_of([&] { files.scenario(scene); }), "calibration.toml not found"));
  files.calibration("[scale]\num_per_px = 1.25\n");
  CHECK(says(
      refusal_of([&] { files.scenario("[scale]\nfile = 'calibration.toml'\num_per_px = 1\n" + kSwarm); }),
      "um_per_px is also given"));
  CHECK(says(refusal_of([&] { files.scenario("[scale]\nfile = 3\n" + kSwarm); }), "expected a string"));
  files.calibration("um_per_px = 1.25\n");
  CHECK(says(refusal_of([&] { files.scenario(scene); }), "section [scale] not found"));
  files.calibration("[scale]\nci95 = [1, 2]\n");
  CHECK(
      says(refusal_of([&] { files.scenario(scene); }), "um_per_px is 0; it must be between 0.001 and 1000"));
  files.calibration("[scale]\num_per_px = -1\n");
  CHECK(says(refusal_of([&] { files.scenario(scene); }), "um_per_px"));
  files.calibration("[scale]\num_per_px = 1.25\numperpx = 2\n");
  CHECK(says(refusal_of([&] { files.scenario(scene); }), "unknown key"));
}

TEST_CASE("a scale on the command line") {
  CHECK(parse_calibration("0.9164", "--scale").um_per_px == 0.9164);
  CHECK(parse_calibration("0.5 um/px", "--scale").um_per_px == doctest::Approx(0.5));
  CHECK(parse_calibration("500 nm/px", "--scale").um_per_px == doctest::Approx(0.5));
  CHECK(says(refusal_of([] { parse_calibration("no-such-file.toml", "--scale"); }), "--scale"));
  CHECK(says(refusal_of([] { parse_calibration("0.5 um", "--scale"); }), "um/px"));
  CHECK(says(refusal_of([] { parse_calibration("-1", "--scale"); }), "out of range"));
}
