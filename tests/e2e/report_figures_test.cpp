// Figures of report pages as a reader sees them: the labels of their axes, and no figure without values.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/e2e/program.h"

using namespace faba;

namespace {

/// Drawings of a page.
std::vector<std::string> drawings(const std::filesystem::path& page) {
  const std::string text = read_file(page);
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = text.find("<svg", at)) != std::string::npos;) {
    const std::size_t end = text.find("</svg>", at);
    out.push_back(text.substr(at, end - at));
    at = end;
  }
  return out;
}

/// Texts of a drawing; a tick is a text.
std::vector<std::string> labels(const std::string& drawing) {
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = drawing.find("<text", at)) != std::string::npos;) {
    const std::size_t start = drawing.find('>', at) + 1;
    at = drawing.find("</text>", start);
    out.push_back(drawing.substr(start, at - start));
  }
  return out;
}

bool has(const std::vector<std::string>& all, const std::string& label) {
  return std::find(all.begin(), all.end(), label) != all.end();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The drawing with this text in it.
std::string drawing_with(const std::filesystem::path& page, const std::string& words) {
  for (const std::string& one : drawings(page))
    if (contains(one, words)) return one;
  FAIL("no figure with " << words << " in " << page.filename().string());
  return {};
}

}  // namespace

TEST_CASE("figures: an angle axis has ticks at 90 degrees, and an axis for the order parameter") {
  const TestFolder f;
  REQUIRE(faba_in(f.path, "run '" FABA_SCENES "/as-seen.toml' --seed 1 --duration '3 s' -q --out run").exit ==
          0);
  REQUIRE(faba_in(f.path, "track run --report track.html -q").exit == 0);
  const std::string drawing = drawing_with(f.path / "track.html", "heading");
  const std::vector<std::string> found = labels(drawing);
  for (const std::string angle : {"90", "180"}) CHECK_MESSAGE(has(found, angle), angle);
  for (const std::string angle : {"50", "100", "150"}) CHECK_MESSAGE(!has(found, angle), angle);
  CHECK(contains(drawing, "order parameter"));
}

TEST_CASE("figures: a delay axis has ticks at integer numbers of frames, and means have error bars") {
  const TestFolder f;
  write_file(f.path / "study.toml",
             "scene = '" FABA_SCENES
             "/null-route.toml'\nseeds = 3\ndelays = [0, 2]\n[[controller]]\ntype = "
             "'gradient_feedback'\n[[model]]\ntype = 'dipole'\npreset = 'IT-1'\nset = { 'duration' = '1 s', "
             "'reference.setpoints_px' = [[320, 240], [322, 240]], 'reference.hold_frames' = 3 }\n");
  const Called c = faba_in(f.path, "compare-controllers study.toml --out study -q");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const std::string drawing = drawing_with(f.path / "study/report.html", "delay (frames)");
  const std::vector<std::string> found = labels(drawing);
  // The ticks of the horizontal axis come first, from 0 to the largest delay.
  const auto zero =
      std::find_if(found.begin(), found.end(), [](const auto& l) { return l.starts_with("0"); });
  REQUIRE(found.end() - zero >= 3);
  CHECK(std::vector<std::string>(zero, zero + 3) == std::vector<std::string>{"0", "1", "2"});
  // Two bars, each with two caps and a line between them.
  const auto bars = [&] {
    for (std::size_t at = 0; (at = drawing.find(" d=\"M", at)) != std::string::npos; ++at) {
      const std::string path = drawing.substr(at + 4, drawing.find('"', at + 4) - at - 4);
      if (std::count(path.begin(), path.end(), 'H') == 4 && std::count(path.begin(), path.end(), 'V') == 2)
        return true;
    }
    return false;
  };
  CHECK(bars());
}

TEST_CASE("figures: the axis of the steady-state error includes the settling band") {
  const TestFolder f;
  REQUIRE(faba_in(f.path, "run '" FABA_SCENES "/steer.toml' --seed 1 -q --out run").exit == 0);
  CHECK(contains(drawing_with(f.path / "run/report.html", ">rms, "), "settling band"));
}

TEST_CASE("figures: a figure without values is replaced by a sentence") {
  const TestFolder f;
  std::filesystem::create_directory(f.path / "film");
  for (int k = 0; k < 8; ++k)
    write_file(f.path / ("film/f" + std::to_string(k) + ".pgm"),
               "P5\n160 120\n255\n" + std::string(160 * 120, char(150)));
  write_file(
      f.path / "s.toml",
      "duration = '0.4 s'\n[arena]\ntype = 'box'\nsize_px = [160, 120]\n[controller]\ntype = 'manual'\n"
      "current = [0, 0]\n[[swarm]]\ncount = 30\nmodel = 'basic'\n[rig]\ndriver = 'none'\n"
      "camera = { type = 'playback', file = 'film', fps = 15, fast = true }\n[estimator]\ntype = 'image'\n");
  const Called c = faba_in(f.path, "rig run s.toml --arm -q --out run");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(contains(read_file(f.path / "run/report.html"),
                 "Dispersion: there are no values, and the figure is omitted."));
  for (const std::string& one : drawings(f.path / "run/report.html"))
    CHECK_FALSE(contains(one, "rms radius"));
}
