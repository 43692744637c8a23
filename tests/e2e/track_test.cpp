#include <doctest/doctest.h>

#include "core/table.h"
#include "program.h"
#include "tests/temporary_folder.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

void film(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  cells::Look l;
  std::vector<Vec2> at = cells::scattered(l, 30, 20, 10, 3);
  for (int k = 0; k < 12; ++k) {
    const Gray8 b = cells::bytes(cells::picture(l, at, std::uint64_t(k)));
    std::string pgm = "P5\n320 240\n255\n" + std::string(b.px.begin(), b.px.end());
    write_file(folder / ("f" + std::to_string(k) + ".pgm"), pgm);
    for (Vec2& p : at) p.x += 3;
  }
}

}  // namespace

TEST_CASE("track: text and JSON output, files, and refused input") {
  const test::TemporaryFolder folder("track");
  film(folder.path() / "film");
  const Called text =
      faba_in(folder.path(), "track film --fps 15 --um-per-px 0.5 --out t.csv --report t.html");
  CHECK(text.exit == 0);
  CHECK(text.out.find("um/s") != std::string::npos);
  CHECK(text.out.find("t.csv") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path() / "t.html"));

  const Called json = faba_in(folder.path(), "track 'film/f%d.pgm' --fps 15 --json");
  CHECK(json.exit == 0);
  CHECK(json.json()["order"].get<double>() > 0.95);
  CHECK(json.json()["speed"]["mean_px_s"].get<double>() == doctest::Approx(45).epsilon(0.03));
  CHECK(json.json()["um_per_px"].is_null());

  for (const auto& [arguments, code] : {std::pair{"track film --out t.csv", 2},
                                        {"track film --out t.txt", 2},
                                        {"track film --overlay o.gif", 2},
                                        {"track film --size 0", 2},
                                        {"track nothing.avi", 3},
                                        {"track 'no*.png'", 3}}) {
    CAPTURE(arguments);
    const Called c = faba_in(folder.path(), arguments);
    CHECK(c.exit == code);
    CHECK(one_clear_line(c.err));
    CHECK(c.out.empty());
  }
  CHECK(faba_in(folder.path(), "track film --fps 15 --out t.csv --force --quiet").exit == 0);

  const Called none = faba_in(folder.path(), "track film --fps 15 --threshold 1000000");
  CHECK(none.err.find("no tracks were found with a threshold of 1e+06; reduce --threshold") !=
        std::string::npos);

  const Called least = faba_in(folder.path(), "track film --fps 15 --least 99999");
  CHECK(least.err.find("no track has 99999 detections (the video has 12 frames); reduce --least") !=
        std::string::npos);

  const Called figures = faba_in(folder.path(), "track film --fps 15 --figures x.svg");
  CHECK(figures.exit == 2);
  CHECK(figures.err.find("x.svg: is the name of a file; --figures must be a folder") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "x.svg"));
  CHECK(faba_in(folder.path(), "track film --fps 15 --figures run-0.5").exit == 0);

  const Called interval = faba_in(folder.path(), "track film --fps 15 --interval 1000");
  CHECK(interval.exit == 0);
  CHECK(interval.err.find(
            "--interval is 1000 frames, but no track has this length (the video has 12 frames)") !=
        std::string::npos);
}

TEST_CASE("track: preview and region before the long job") {
  const test::TemporaryFolder folder("preview");
  film(folder.path() / "film");
  const Called text = faba_in(folder.path(), "track film --fps 15 --region 40,30,200,150 --preview p.png");
  CHECK(text.exit == 0);
  CHECK(text.out.find("--region 40,30,200,150 (given)") != std::string::npos);
  CHECK(text.out.find("--size ") != std::string::npos);
  CHECK(std::filesystem::file_size(folder.path() / "p.png") > 1000);
  const auto shown = faba_in(folder.path(), "track film --preview q.png --size 3 --json").json();
  CHECK(shown["frames"].size() == 9);
  CHECK(shown["detection"]["size_given"] == true);
  CHECK(shown["detection"]["region"].is_null());
  for (const auto& frame : shown["frames"]) CHECK(std::abs(frame["spots"].get<int>() - 28) <= 3);

  const auto part =
      faba_in(folder.path(), "track film --fps 15 --region 40,30,200,150 --json --per-track t.csv").json();
  CHECK(part["detection"]["region"] == nlohmann::json{40, 30, 200, 150});
  CHECK(part["tracks"].get<int>() > 3);
  CHECK(part["tracks"].get<int>() < 25);
  CHECK(part["track_quality"]["mean"].get<double>() > 0.5);
  const Table each = read_table(folder.path() / "t.csv");
  CHECK(each.size() == part["tracks"].get<std::size_t>());

  for (const char* arguments :
       {"track film --region 300,30,200,150", "track film --region 1,2,3", "track film --region 0,0,5,5",
        "track film --preview r.png --out u.csv", "track film --preview r.jpg"}) {
    CAPTURE(arguments);
    const Called c = faba_in(folder.path(), arguments);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
  }
}

TEST_CASE("estimator image: the centroid of a swarm at the edge of a drop from rendered frames") {
  const test::TemporaryFolder folder("as-seen");
  const Called run = faba_in(
      folder.path(), "run '" FABA_SCENES
                     "/as-seen.toml' --duration '2.6 s' --out run --quiet "
                     "--set camera.sensor=frames --set estimator.type=image --set record.video=false");
  REQUIRE(run.exit == 0);
  const Table t = read_table(folder.path() / "run/series.csv");
  // All cells are in view in these frames. The first pictures, with all cells at the edge, give an error of
  // 20 px.
  for (std::size_t k = 10; k < t.size(); ++k) {
    CAPTURE(k);
    CHECK(std::hypot(t.column("estimated_centroid_x_px")[k] - t.column("true_centroid_x_px")[k],
                     t.column("estimated_centroid_y_px")[k] - t.column("true_centroid_y_px")[k]) < 2);
  }
}
