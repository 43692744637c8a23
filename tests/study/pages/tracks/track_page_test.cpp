#include "study/pages/tracks/track_page.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "study/pages/tracks/track_figures.h"
#include "study/pages/tracks/track_json.h"
#include "study/plot/plot_svg.h"
#include "tests/study/well_formed.h"

namespace {

using namespace faba;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string page_with_turns(double deg_s, double se, double noise_deg_s) {
  TrackMeasurement m;
  m.summary.tracks = 3;
  m.summary.turn_count = 100;
  m.summary.turn_deg_s = {deg_s, se};
  m.summary.turn_noise_deg_s = noise_deg_s;
  const std::string page = track_page(m, {}, RgbImage(8, 6));
  CHECK(test::XmlCheck::complaint(page) == "");
  return page;
}

}  // namespace

TEST_CASE("track page: a rate of turn within its error is not distinguishable from zero") {
  const std::string page = page_with_turns(30, 2, 28);
  CHECK(has(page, "not distinguishable from zero: the mean absolute rate is 30.0 ± 2.0\u00A0°/s, and the"));
  CHECK(has(page, "alone gives 28.0°/s"));
  CHECK_FALSE(has(page_with_turns(40, 2, 28), "not distinguishable"));
}

TEST_CASE("track page: speeds of several populations are not summarised by one mean") {
  TrackMeasurement m;
  m.summary.tracks = 40;
  m.summary.speed_count = 100;
  m.summary.mean_speed_px_s = {13.57, 0.4};
  m.populations = {{0.5, 0.2, {0.1, 0.3}, PopulationMotion::still, 20},
                   {0.5, 27.1, {26, 28}, PopulationMotion::moving, 20}};
  const std::string page = track_page(m, {}, RgbImage(8, 6));
  CHECK(test::XmlCheck::complaint(page) == "");
  CHECK(has(page, "27.1"));
  CHECK_FALSE(has(page, "13.5"));
  CHECK_FALSE(has(page, "13.6"));
  CHECK_FALSE(has(page, "Mean speed"));
  const auto j = track_json(m);
  CHECK(j["speed"]["mean_px_s"].is_null());
  CHECK(j["populations"].size() == 2);
  m.populations.pop_back();
  CHECK(has(track_page(m, {}, RgbImage(8, 6)), "13.57"));
  CHECK(track_json(m)["speed"]["mean_px_s"] == 13.57);
}

TEST_CASE("track page: the figure of the direction has an axis for the order parameter") {
  TrackSummary s;
  s.time_s = {0, 1, 2};
  s.velocity_x_px_s = {1, 1, 1};
  s.velocity_y_px_s = {0, 0, 0};
  s.order_in_time = {0, 0.5, 1};
  s.count_in_time = {100, 100, 100};
  const auto figures = track_figures(s, 0);
  REQUIRE(figures.size() == 1);
  REQUIRE(figures[0].plot.right);
  const SecondScale& right = *figures[0].plot.right;
  CHECK(right.per_unit * -180 + right.offset == doctest::Approx(0));
  CHECK(right.per_unit * 180 + right.offset == doctest::Approx(1));
  const std::string drawn = svg(figures[0].plot);
  CHECK(has(drawn, ">order parameter</text>"));
  CHECK(has(drawn, ">0.8</text>"));
}
