#include "app/files/from_picture.h"

#include <doctest/doctest.h>

#include "app/recording/manifest.h"
#include "app/run/notes.h"
#include "tests/app/run_directory.h"
#include "tests/vision/raw_files.h"

using namespace faba;

namespace {

constexpr const char* kScene = "duration = '0.2 s'\n[[swarm]]\ncount = 5\n";

std::filesystem::path picture(const TestFolder& f, const std::string& description) {
  media::TiffPage page;
  page.width = 16;
  page.height = 8;
  page.pixels = std::string(128, 'x');
  page.description = description;
  write_file(f.path / "p.tif", media::tiff_file({page}));
  return f.path / "p.tif";
}

const std::string kStated = "<OME><Pixels PhysicalSizeX='0.65'/></OME>";

// The scale of a scenario for a picture, with the note in `note`.
Scenario fitted(const std::string& toml, const std::string& description, std::string* note = nullptr) {
  const TestFolder f;
  Document d = parse_toml(toml, "test.toml");
  const std::string text = take_scale(d, picture(f, description));
  if (note) *note = text;
  return read_scenario(d, builtin_parts());
}

Json manifest(const Scenario& s) { return manifest_json(manifest_of(s, 1, {}, {})); }

}  // namespace

TEST_CASE("the scale of a picture without metadata is nominal, and lengths are not stated in um") {
  const Scenario s = fitted(kScene, "");
  CHECK_FALSE(s.scale.um_per_px);
  CHECK(s.si_scale().m_per_px == doctest::Approx(kNominalUmPerPx * 1e-6));
  const Json j = manifest(s);
  CHECK(j["um_per_px"].is_null());
  CHECK(j["um_per_px_source"].is_null());
  CHECK(j["nominal_um_per_px"] == kNominalUmPerPx);
  CHECK(scale_note(s.scale).find("not known") != std::string::npos);
  CHECK(fitted(std::string(kScene) + "[scale]\nnominal_um_per_px = 2\n", "").si_scale().m_per_px == 2e-6);
}

TEST_CASE("the scale of the metadata of a picture is used") {
  std::string note;
  const Scenario s = fitted(kScene, kStated, &note);
  CHECK(note.empty());
  CHECK(s.scale.um_per_px == 0.65);
  const Json j = manifest(s);
  CHECK(j["um_per_px"] == 0.65);
  CHECK(j["um_per_px_source"] == "metadata");
  CHECK_FALSE(j.contains("nominal_um_per_px"));
  CHECK(scale_note(s.scale).empty());
}

TEST_CASE("a scale of the user has precedence, with a note if the metadata differ") {
  std::string note;
  const Scenario s = fitted(std::string(kScene) + "[scale]\num_per_px = 1.3\n", kStated, &note);
  CHECK(s.scale.um_per_px == 1.3);
  CHECK(manifest(s)["um_per_px_source"] == "typed");
  CHECK(note.find("0.65") != std::string::npos);
  fitted(std::string(kScene) + "[scale]\num_per_px = 0.65\n", kStated, &note);
  CHECK(note.empty());
  (void)fitted(kScene, "<OME><Pixels PhysicalSizeX='-1'/></OME>", &note);
  CHECK(note.find("not a number above 0") != std::string::npos);
}

TEST_CASE("the origin of the scale stays the same when a resolved scenario is read again") {
  for (const char* scale : {"", "[scale]\num_per_px = 1.3\n", "[scale]\nnominal_um_per_px = 2\n",
                            "[scale]\num_per_px = 1.3\num_per_px_source = 'metadata'\n"}) {
    const Scenario s = scenario_from(std::string(kScene) + scale);
    const Scenario again = scenario_from(to_toml(s.resolved()));
    CHECK(again.resolved() == s.resolved());
    CHECK(again.hash() == s.hash());
    CHECK(manifest(again)["um_per_px_source"] == manifest(s)["um_per_px_source"]);
    CHECK(manifest(again)["um_per_px"] == manifest(s)["um_per_px"]);
  }
  // The default of a simulated camera is known, but no one has stated it.
  const Json j = manifest(scenario_from(kScene));
  CHECK(j["um_per_px"] == kNominalUmPerPx);
  CHECK(j["um_per_px_source"].is_null());
}

TEST_CASE("--set replaces the scale of the metadata and its origin") {
  Document d = parse_toml(std::string(kScene) + "[scale]\num_per_px = 0.65\num_per_px_source = 'metadata'\n",
                          "test.toml");
  d.set("scale.um_per_px", std::string("1.1"), "--set");
  CHECK(manifest(read_scenario(d, builtin_parts()))["um_per_px_source"] == "typed");
}

TEST_CASE("pictures of a bench have no default scale") {
  ScaleParams p;
  p.require_known();
  CHECK_FALSE(p.um_per_px);
  CHECK(p.used_um_per_px() == kNominalUmPerPx);
  ScaleParams typed;
  typed.um_per_px = 1.3;
  typed.um_per_px_source = ScaleParams::Source::typed;
  typed.require_known();
  CHECK(typed.um_per_px == 1.3);
}
