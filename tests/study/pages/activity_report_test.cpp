#include "study/pages/activity_report.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/study/well_formed.h"

namespace {

using namespace faba;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

ActivityResult one_video(bool good) {
  VideoActivity a;
  a.input.file = "film.mp4";
  a.t_s = {0, 1, 2, 3};
  a.amount = a.along = {0, 5, 1, 0};
  a.segments = {{0.5, 1.5, 90}};
  a.fit.good = good;
  a.fit.peak_s = 1;
  a.fit.sigma_s = 0.25;
  a.fit.se_peak_s = 0.02;
  a.fit.amplitude = 5;
  if (good) {
    a.maximum_s = 1;
    a.um_per_px = 0.5;
    Response r;
    r.earliest_s = 0.25;
    r.responds = true;
    r.change.t_s = 0.5;
    r.change.ci90 = {0.3, 0.7};
    r.fraction = Measured{0.75, {0.5, 1}};
    r.speed_px_s = Measured{100, {90, 110}};
    a.response = r;
  } else {
    a.fit.reason = "the peak is wider than the video";
  }
  ActivityResult r;
  r.videos.push_back(a);
  return r;
}

}  // namespace

TEST_CASE("activity report: onset, fraction and speed with their 90 % intervals") {
  const ActivityResult r = one_video(true);
  const std::string page = activity_page(r);
  CHECK(test::XmlCheck::complaint(page) == "");
  CHECK(has(page, "0.50 [0.30, 0.70]"));
  CHECK(has(page, "field reversal at 0.250 s"));
  CHECK(has(page, "standard error 0.0200 s"));
  CHECK(has(page, "The cells respond to the field reversal: a fraction of 0.75 [0.50, 1.00] at "));
  const auto video = activity_json(r)["videos"][0];
  CHECK(video["onset_s"] == 0.5);
  CHECK(video["onset_ci90"][0] == 0.3);
  CHECK(video["onset_ci90"][1] == 0.7);
  CHECK(video["responding_fraction"] == 0.75);
  CHECK(video["responding_fraction_ci90"][0] == 0.5);
  CHECK(video["speed_px_per_s"] == 100);
  CHECK(video["speed_um_per_s"] == 50);
  CHECK(video["speed_um_per_s_ci90"][1] == 55);
  CHECK(video["response"]["reversal_s"] == 0.25);
}

TEST_CASE("activity report: the interval of a speed in um/s includes the standard error of the scale") {
  ActivityResult r = one_video(true);
  CHECK(activity_json(r)["videos"][0]["um_per_px_se"].is_null());
  r.videos[0].scale.um_per_px = 0.5;
  r.videos[0].scale.standard_error = 0.1;
  const auto video = activity_json(r)["videos"][0];
  CHECK(video["um_per_px_se"] == 0.1);
  CHECK(video["speed_um_per_s"] == 50);
  // 5 um/s of the speed, and 1.645 * 0.1 um/px * 100 px/s of the scale.
  CHECK(video["speed_um_per_s_ci90"][0].get<double>() == doctest::Approx(50 - std::hypot(5, 16.45)));
  CHECK(video["speed_um_per_s_ci90"][1].get<double>() == doctest::Approx(50 + std::hypot(5, 16.45)));
  CHECK(video["speed_px_per_s_ci90"][1] == 110);
  CHECK(has(activity_page(r), "50 [33, 67] µm/s"));
}

TEST_CASE("activity report: a failed fit has a reason and no onset, maximum or width") {
  const ActivityResult r = one_video(false);
  const std::string page = activity_page(r);
  CHECK(test::XmlCheck::complaint(page) == "");
  CHECK(has(page, "The Gaussian fit failed: the peak is wider than the video. No maximum"));
  CHECK(has(page, "<td>–</td><td>–</td><td>–</td></tr>"));
  CHECK_FALSE(has(page, "(1) Onset"));
  const auto video = activity_json(r)["videos"][0];
  CHECK(video["onset_s"].is_null());
  CHECK(video["onset_ci90"].is_null());
  CHECK(video["gaussian"]["good"] == false);
}

TEST_CASE("activity report: the headings of the columns are in the head of each table") {
  const std::string page = activity_page(one_video(true));
  CHECK(has(page, "<thead><tr><th scope=\"col\">video</th><th scope=\"col\">direction</th>"));
  CHECK(has(page, "<thead><tr><th scope=\"col\">video</th><th scope=\"col\">from (s)</th>"));
}

TEST_CASE("activity report: the headline agrees with the response and with the quality") {
  ActivityResult r = one_video(true);
  r.videos[0].segments.clear();
  CHECK(has(activity_page(r), "The cells respond to the field reversal"));
  CHECK_FALSE(has(activity_page(r), "No significant motion"));
  r.videos[0].warnings = {{"direction", "wrong", "", "", Quality::poor}};
  CHECK(has(activity_page(r), "could not be measured"));
  r.videos[0].warnings.clear();
  r.videos[0].response->responds = false;
  CHECK(has(activity_page(r), "No response to the field reversal was detected."));
}
