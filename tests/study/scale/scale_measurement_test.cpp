#include "study/scale/scale_measurement.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/random/distributions.h"
#include "core/toml.h"
#include "study/pages/scale_report.h"
#include "study/stats/statistics.h"
#include "tests/app/run_directory.h"
#include "tests/vision/drop_pictures.h"

using namespace faba;

namespace {

// Table 4.1 of the thesis.
const char* const kTable41 =
    "width_um,px_1,px_2\n30,41.42,40.31\n50,63.25,64.19\n70,87.52,90.10\n100,121.44,122.40\n"
    "200,228.55,225.66\n";

TableScale measured(const std::string& csv) {
  const TestFolder folder;
  const auto file = folder.path / "ruler.csv";
  write_file(file, csv);
  return measure_scale(read_ruler_table(file), file.string());
}

Json report(const std::string& csv) { return scale_json(measured(csv)); }

std::string refused(const std::string& csv) {
  try {
    report(csv);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::input);
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("table 4.1 to all printed digits") {
  const auto j = report(kTable41);
  const auto fixed = [&](const char* key, int digits) {
    return fmt::format("{:.{}f}", j[key].get<double>(), digits);
  };
  const auto end = [&](const char* key, int i, int digits) {
    return fmt::format("{:.{}f}", j[key][std::size_t(i)].get<double>(), digits);
  };
  // REFERENCE A20; the same numbers are in docs/theory/thesis-models.md.
  CHECK(fixed("intercept_px", 2) == "10.27");
  CHECK(end("intercept_ci95_px", 0, 1) == "7.1");
  CHECK(end("intercept_ci95_px", 1, 1) == "13.5");
  CHECK(fixed("slope_px_per_um", 4) == "1.0912");
  CHECK(fixed("um_per_px", 4) == "0.9164");
  CHECK(end("ci95", 0, 3) == "0.892");
  CHECK(end("ci95", 1, 3) == "0.942");
  CHECK(fixed("repeatability_px", 2) == "1.34");
  const char* const ratios[] = {"0.734125", "0.784683", "0.788200", "0.820210", "0.880650"};
  for (int i = 0; i < 5; ++i) CHECK(end("ratios", i, 6) == ratios[i]);
  CHECK(fixed("ratio_mean", 6) == "0.801573");
  CHECK(fixed("ratio_sd", 6) == "0.053884");
  CHECK(fixed("ratio_sd_population", 6) == "0.048195");
  CHECK(fixed("ratio_sem", 4) == "0.0241");
  CHECK(j["spearman"].get<double>() == doctest::Approx(1));
  CHECK(j["edge_excess_significant"] == true);
  CHECK(1 / (1 + j["ratio_bias"].get<double>()) == doctest::Approx(1.143).epsilon(5e-4));
  CHECK(j["recommended"] == "regression");
}

TEST_CASE("all forms of the same table give the same result") {
  const auto wanted = report(kTable41);
  std::string narrow = "width_um,px\n", mm = "\"Width (mm)\",first,second\n",
              other = "n,pixels a,pixels b,um\n";
  const double rows[][3] = {{30, 41.42, 40.31},
                            {50, 63.25, 64.19},
                            {70, 87.52, 90.10},
                            {100, 121.44, 122.40},
                            {200, 228.55, 225.66}};
  mm = "Width (mm),first,second\n";
  int n = 0;
  for (const auto& r : rows) {
    narrow += fmt::format("{},{}\n{},{}\n", r[0], r[1], r[0], r[2]);
    mm += fmt::format("{},{},{}\n", r[0] / 1000, r[1], r[2]);
    other += fmt::format("{},{},{},{}\n", ++n, r[1], r[2], r[0]);
  }
  for (const std::string& csv : {narrow, mm, other}) {
    CAPTURE(csv);
    const auto j = report(csv);
    for (const char* key : {"um_per_px", "ratio_mean", "ratio_sd", "repeatability_px"})
      CHECK(j[key].get<double>() == doctest::Approx(wanted[key].get<double>()).epsilon(1e-12));
    CHECK(j["widths_um"] == wanted["widths_um"]);
  }
  CHECK(report("µm,px\n10,20\n20,40.1\n30,60\n")["um_per_px"].get<double>() ==
        doctest::Approx(0.5).epsilon(0.02));
  CHECK(report("width_microns,px\n10,20\n20,40.1\n30,60\n")["repeatability_px"].is_null());
}

TEST_CASE("the confidence interval has its nominal coverage") {
  // 400 tables of 6 widths read twice, 1.2 um/px, 7 px of edge, readings with an error of 1.5 px. The number
  // of hits is binomial: 380 +- 4.4; tolerance of 5 standard deviations.
  int hits = 0, ratio_hits = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    FrameNoise noise(seed);
    RulerReadings r;
    for (const double w : {20.0, 40.0, 60.0, 100.0, 150.0, 300.0})
      for (int k = 0; k < 2; ++k) {
        r.width_m.push_back(w * 1e-6);
        r.reading_px.push_back(7 + w / 1.2 + 1.5 * noise.gauss());
      }
    const TableScale s = measure_scale(r, "made");
    hits += s.ci95[0] < 1.2 && 1.2 < s.ci95[1];
    const double half_ci = student_t_quantile(0.975, 5) * s.ratios.sem;
    ratio_hits += std::fabs(s.ratios.mean - 1.2) < half_ci;
  }
  CHECK(hits > 358);
  CHECK(ratio_hits < 200);  // biased by the edges
}

TEST_CASE("without an edge excess both estimators agree, and the note states it") {
  const TableScale s = measured("width_um,px_1,px_2\n10,20.1,19.9\n20,40.2,39.9\n50,99.8,100.3\n");
  CHECK_FALSE(s.edge_excess_significant());
  CHECK(s.ratios.mean == doctest::Approx(s.um_per_px).epsilon(0.01));
  CHECK(says(scale_note(s), "not significantly different from 0"));
}

TEST_CASE("readings that bend are named; straight ones are not") {
  // A lens that distorts: readings of wide distances are 8 % too large.
  std::string bent = "width_um,px\n", straight = bent;
  for (int i = 0; i < 12; ++i) {
    const double width = 20 * (i / 2 + 1), scatter = i % 2 == 0 ? 0.3 : -0.3;
    straight += fmt::format("{},{}\n", width, 1.2 * width + scatter);
    bent += fmt::format("{},{}\n", width, 1.2 * width * (1 + 0.08 * width * width / 14400) + scatter);
  }
  CHECK(measured(straight).warnings.empty());
  REQUIRE(measured(bent).warnings.size() == 1);
  CHECK(measured(bent).warnings[0].aspect == "linearity");
  CHECK(measured(kTable41).warnings.empty());
}

TEST_CASE("invalid tables are refused") {
  CHECK(says(refused("dear diary\nwe measured\n"), ":2"));
  CHECK(says(refused("width_um,px\n30,41\nforty,52\n"), ":3"));
  CHECK(says(refused("width,px\n30,41\n50,63\n70,88\n"), "width_um"));
  CHECK(says(refused("width_um,length_mm\n30,41\n50,63\n70,88\n"),
             "two columns with a unit of length, width_um and length_mm; only the column of widths"));
  CHECK(says(refused("width_um\n30\n50\n"), "no column of readings"));
  CHECK(says(refused("width_um,px\n"), "no readings"));
  CHECK(says(refused("width_um,px_1,px_2,px_3\n30,41,42,40\n"), "all of the width"));
  CHECK(says(refused("width_um,px\n30,41\n50,63\n"), "three readings"));
  CHECK(says(refused("width_um,px\n-30,41\n50,63\n70,88\n"), "greater than 0"));
  CHECK(says(refused("width_um,px\n30,41\n50,0\n70,88\n"), ":3"));
  CHECK(says(refused("width_um,px\n30,41\n50,nan\n70,88\n"), "not a number"));
  CHECK(says(refused("width_um,px_1,px_2\n30,41,42\n50,,63\n70,88,89\n"), "empty"));
  CHECK(says(refused("width_um,px\n30,inf\n50,63\n70,88\n"), ":2"));
  CHECK(says(refused("width_um,px\n30,88\n50,63\n70,41\n"), "do not increase"));
  CHECK(says(refused("width_um,px\n30,50\n50,80\n70,51\n"), "do not increase significantly"));
}

TEST_CASE("the calibration file of a measurement can be read") {
  const TestFolder folder;
  const auto file = folder.path / "calibration.toml";
  const TableScale s = measured(kTable41);
  write_calibration(file, calibration_of(s));
  const Calibration c = read_calibration(file);
  CHECK(c.um_per_px == s.um_per_px);
  REQUIRE(c.ci95);
  CHECK(c.ci95->x == s.ci95[0]);
  CHECK(c.ci95->y == s.ci95[1]);
  CHECK(says(c.source, "ruler.csv"));
  CHECK(parse_calibration(file.string(), "--scale").um_per_px == c.um_per_px);
}
