#include "study/pages/run_report.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "study/pages/run_figures.h"
#include "tests/study/well_formed.h"
#include "tests/temporary_folder.h"

namespace {

void report(const std::filesystem::path& run) {
  const faba::RunInfo info = faba::read_run_info(run / "manifest.json");
  faba::write_run_report(run, info, faba::read_series(run / "series.csv"));
}

using faba::Metrics;
using faba::RunInfo;
using faba::test::TemporaryFolder;

constexpr const char* kManifest = R"json({
  "version": "0.1.0",
  "seed": 42, "threads": 2,
  "state_hash": "9f3c1a77be02d451", "scenario_hash": "51aa02c3",
  "frames": 60, "duration_s": 4.0, "um_per_px": 0.8,
  "title": "Hold <b>\"still\"</b> & wait", "wall_time_s": 0.5,
  "view_px": [640, 480], "arena": {"type": "drop", "centre_px": [700, 240], "radius_px": 760},
  "polarity": "south-seeking", "swarms": [{"model": "adapted", "count": 500}]
})json";

/// 60 frames at 15 Hz, from a distance of 300 px to the setpoint (320, 240) within 2 s, with all columns of a
/// run.
std::string full_series() {
  std::string csv =
      "frame,t_s,true_centroid_x_px,true_centroid_y_px,true_sigma_x_px,true_sigma_y_px,true_rms_radius_px,"
      "distance_px,visible_count,"
      "responding_count,estimated_centroid_x_px,estimated_centroid_y_px,setpoint_x_px,setpoint_y_px,field_x_"
      "ut,field_y_ut,"
      "current_0_a,"
      "current_1_a,limited\n";
  for (int k = 0; k < 60; ++k) {
    const double distance = k < 30 ? 300.0 - 10 * k : 2, x = 320 - distance;
    for (const double v : {double(k), k / 15.0, x, 240.0, 20.0 + k, 30.0, 40.0 + k, distance, 500.0 - k,
                           450.0, x, 240.0, 320.0, 240.0, distance / 10, -1.5, distance / 300, -0.1}) {
      csv += std::to_string(v) + ",";
    }
    csv += k < 10 ? "1\n" : "0\n";
  }
  return csv;
}

void put(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}
std::string get(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string report_of(const TemporaryFolder& run) {
  report(run.path());
  const std::string html = get(run.path() / "report.html");
  CHECK(faba::test::XmlCheck::complaint(html) == "");
  for (const char* outside :
       {"http:", "https:", "src=\"//", "@import", "url(", "<script", "<link", "<iframe"}) {
    CHECK_MESSAGE(!has(html, outside), outside);
  }
  CHECK_FALSE(has(html, run.path().string()));
  CHECK_FALSE(has(html, ">nan"));
  return html;
}

faba::Errc code_of(const TemporaryFolder& run, const std::string& where, const std::string& part) {
  try {
    report(run.path());
  } catch (const faba::Error& e) {
    CHECK(has(e.where(), where));
    CHECK_MESSAGE(has(e.what(), part), e.what());
    return e.code();
  }
  FAIL("nothing was thrown");
  return {};
}

}  // namespace

TEST_CASE(
    "run report: a run with all data has every figure, both units, its video and the reproduction command") {
  const TemporaryFolder run("report");
  put(run.path() / "series.csv", full_series());
  put(run.path() / "manifest.json", kManifest);
  put(run.path() / "scenario.toml", "title = \"Hold <b>\"  # 1 < 2 & so on\n");
  put(run.path() / "video.mp4", "not a video");
  put(run.path() / "report.html", "an older one");
  const std::string html = report_of(run);

  for (const char* heading : {"Distance to the setpoint", "Path in the picture", "Steady-state error",
                              "Dispersion", "Magnetic field", "Coil currents", "Cells"}) {
    CHECK_MESSAGE(has(html, std::string("<h3>") + heading + "</h3>"), heading);
  }
  for (const char* words :
       {"settling band", "settled,", "drop edge", "coil 1", "limited", "visible", "distance (µm)"}) {
    CHECK_MESSAGE(has(html, words), words);
  }
  // The band is 15 px; the distance is 20 px at frame 28 and 10 px at frame 29, which is 29 / 15 s.
  CHECK(has(html, "The swarm settled at its setpoint after 1.93\u00A0s"));
  CHECK(has(html, "<td>300\u00A0px</td><td>240\u00A0µm</td>"));  // the initial error at 0.8 um per px
  CHECK(has(html, "<td>2.00\u00A0px</td><td>1.60\u00A0µm</td>"));
  CHECK(has(html, "<title>Hold &lt;b&gt;&quot;still&quot;&lt;/b&gt; &amp; wait</title>"));
  CHECK_FALSE(has(html, "<b>\"still"));
  CHECK(has(html, "src=\"video.mp4\""));
  CHECK_FALSE(has(html, "<h3>Frames</h3>"));  // the video cannot be read
  CHECK(has(html, "controls"));
  CHECK(has(html, "faba run scenario.toml --seed 42 --out repeated"));
  CHECK(has(html, "9f3c1a77be02d451"));
  CHECK(has(html, "Faba 0.1.0"));
  CHECK(has(html, "# 1 &lt; 2 &amp; so on"));
  CHECK_FALSE(has(html, "real time"));  // of the computer, not of the result
  CHECK_FALSE(has(html, "Threads"));
  // printf 'title = "Hold <b>"  # 1 < 2 & so on\n' | sha256sum
  CHECK(
      has(html, "SHA-256 <code title=\"c5d5657ebc7f549439c24a08076f0a377ce101b967e9d858cc54e37a46dceeb3\">"));
  CHECK(has(html, "4.00 s (60 frames of 66.7 ms)"));
  CHECK_FALSE(std::filesystem::exists(run.path() / "report.html.tmp"));
}

TEST_CASE("run report: a run with minimal data") {
  const TemporaryFolder run("report");
  put(run.path() / "series.csv",
      "frame,t_s,true_centroid_x_px,true_centroid_y_px,true_sigma_x_px,true_sigma_y_px,true_rms_radius_px,"
      "distance_px\n"
      "0,0,10,20,3,4,5,\n1,1,11,20,3,4,5,\n");
  put(run.path() / "manifest.json", R"({"version": "0.1.0", "um_per_px": null, "arena": null})");
  const std::string html = report_of(run);
  CHECK(has(html, "had no setpoint"));
  CHECK(has(html, "lengths are in pixels only"));
  CHECK_FALSE(has(html, "stopped before"));
  CHECK(has(html, "<h3>Path in the picture</h3>"));
  CHECK(has(html, "<h3>Dispersion</h3>"));
  for (const char* absent : {"Distance to the setpoint</h3>", "Magnetic field</h3>", "Coil currents</h3>",
                             "Cells</h3>", "<video", "<details", "To reproduce", "µm</td>", "State hash"}) {
    CHECK_MESSAGE(!has(html, absent), absent);
  }
}

TEST_CASE("run report: no frames, and a recording truncated in the middle of a line") {
  const TemporaryFolder run("report");
  const std::string head =
      "frame,t_s,true_centroid_x_px,true_centroid_y_px,true_sigma_x_px,true_sigma_y_px,true_rms_radius_px,"
      "distance_px\n";
  put(run.path() / "manifest.json", R"({"version": "0.1.0", "complete": false})");
  put(run.path() / "series.csv", head);
  CHECK(has(report_of(run), "No frame was recorded."));
  put(run.path() / "series.csv", head + "0,0,10,20,3,4,5,80\n1,0.1,12,20,3,4,");
  const std::string html = report_of(run);
  CHECK(has(html, "in the middle of a line"));
  CHECK(has(html, "Only one frame was recorded"));
  CHECK(has(html, "stopped before its end"));
}

TEST_CASE("run report: missing or invalid data give an error, and an older report is kept") {
  const TemporaryFolder run("report");
  put(run.path() / "report.html", "an older one");
  CHECK(code_of(run, "manifest.json", "") == faba::Errc::input);
  put(run.path() / "manifest.json", "{\"version\": ");
  CHECK(code_of(run, "manifest.json", "JSON") == faba::Errc::input);
  put(run.path() / "manifest.json", "[1, 2]");
  CHECK(code_of(run, "manifest.json", "JSON") == faba::Errc::input);
  put(run.path() / "manifest.json", R"({"seed": 1})");
  CHECK(code_of(run, "manifest.json", "version") == faba::Errc::input);
  for (const auto& [json, key] :
       {std::pair{R"("um_per_px": "0.8")", "um_per_px"},
        {R"("um_per_px": -1)", "um_per_px"},
        {R"("view_px": [640])", "view_px"},
        {R"("view_px": [640, 0])", "view_px"},
        {R"("arena": "drop")", "arena"},
        {R"("arena": {"centre_px": [1, 2], "radius_px": "big"})", "arena.radius_px"},
        {R"("swarms": {})", "swarms"},
        {R"("swarms": ["basic"])", "swarms"},
        {R"("complete": 1)", "complete"},
        {R"("title": ["a"])", "title"}}) {
    put(run.path() / "manifest.json", std::string(R"({"version": "0.1.0", )") + json + "}");
    CHECK(code_of(run, "manifest.json", key) == faba::Errc::input);
  }
  put(run.path() / "manifest.json", R"({"version": "0.1.0"})");
  CHECK(code_of(run, "series.csv", "") == faba::Errc::input);
  put(run.path() / "series.csv", "frame,t_s\n0,0\n");
  CHECK(code_of(run, "series.csv:1", "distance_px") == faba::Errc::input);
  CHECK(get(run.path() / "report.html") == "an older one");
}

TEST_CASE("run report: the fields of a manifest are read") {
  const TemporaryFolder run("report");
  put(run.path() / "manifest.json", kManifest);
  const RunInfo info = faba::read_run_info(run.path() / "manifest.json");
  CHECK(info.version == "0.1.0");
  CHECK(info.seed == "42");
  CHECK(info.title == "Hold <b>\"still\"</b> & wait");
  CHECK(*info.um_per_px == 0.8);
  CHECK(info.view_px->x == 640);
  CHECK(info.view_px->y == 480);
  CHECK(info.arena->type == "drop");
  CHECK(info.arena->centre_px == faba::Vec2{700, 240});
  CHECK(*info.arena->radius_px == 760);
  CHECK_FALSE(info.arena->size_px);
  REQUIRE(info.swarms.size() == 1);
  CHECK(info.swarms[0] == "model adapted, count 500");
}

TEST_CASE(
    "run report: the last frame in the band does not settle a run that ended before its last setpoint") {
  const TemporaryFolder run("report");
  std::string csv =
      "frame,t_s,true_centroid_x_px,true_centroid_y_px,true_sigma_x_px,true_sigma_y_px,true_rms_radius_px,"
      "distance_px,setpoint_x_px,setpoint_y_px\n";
  for (int k = 0; k < 30; ++k)
    csv += std::to_string(k) + "," + std::to_string(0.1 * k) + ",9,9,3,4,5," + (k < 5 ? "100" : "2") +
           ",50,50\n";
  put(run.path() / "series.csv", csv);
  const auto page = [&](int setpoints) {
    put(run.path() / "manifest.json",
        R"({"version": "0.1.0", "setpoints": )" + std::to_string(setpoints) + "}");
    return report_of(run);
  };
  const std::string settled = page(1), unfinished = page(4);
  CHECK(has(settled, "The swarm settled at its setpoint after 0.500"));
  CHECK(has(settled, ">settled, 0.500 s<"));  // in the plot
  CHECK(has(unfinished, "<dt>Settling time</dt><dd><b>not settled</b>"));
  CHECK(has(unfinished, "so the swarm is not settled"));
  CHECK_FALSE(has(unfinished, ">settled, 0.500 s<"));
  CHECK_FALSE(has(unfinished, "<h3>Approach</h3>"));
}

TEST_CASE("run report: a figure without values is replaced by a sentence") {
  const TemporaryFolder run("report");
  put(run.path() / "manifest.json", R"({"version": "0.1.0", "view_px": [100, 80]})");
  put(run.path() / "series.csv",
      "frame,t_s,estimated_centroid_x_px,estimated_centroid_y_px,estimated_sigma_x_px,estimated_sigma_y_px,"
      "distance_px\n0,0,,,,,\n1,1,,,,,\n");
  const std::string html = report_of(run);
  CHECK_FALSE(has(html, "no data"));
  CHECK(has(html, "Path in the picture: there are no values, and the figure is omitted."));
  CHECK(has(html, "Dispersion: there are no values, and the figure is omitted."));
  CHECK_FALSE(has(html, "<svg"));
}

TEST_CASE(
    "run report: the axis of the steady-state error includes the settling band; the video has a poster") {
  const TemporaryFolder run("report");
  put(run.path() / "series.csv", full_series());
  put(run.path() / "manifest.json", kManifest);
  put(run.path() / "video.mp4", "not a video");
  const faba::Series series = faba::read_series(run.path() / "series.csv");
  double top = 0;
  for (const faba::Figure& f : run_figures(series, control_metrics(series), {}))
    if (f.heading == "Steady-state error")
      for (const auto& layer : f.plot.layers)
        if (const auto* band = std::get_if<faba::Band>(&layer)) top = band->hi;
  CHECK(top == 15);  // 5 % of 300 px
  CHECK_FALSE(has(report_of(run), " poster="));
  const faba::SmallFrame frame{faba::RgbImage(4, 3), 0};
  write_run_report(run.path(), faba::read_run_info(run.path() / "manifest.json"), series, {frame});
  CHECK(has(get(run.path() / "report.html"),
            "<video controls=\"controls\" preload=\"metadata\" width=\"640\" "
            "height=\"480\" poster=\"data:image/png;base64,"));
}
