#include "study/pages/activity_report.h"

#include <doctest/doctest.h>

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
    a.onset_s = 0.5;
    a.se_onset_s = 0.1;
  } else {
    a.fit.reason = "the peak is wider than the video";
  }
  ActivityResult r;
  r.videos.push_back(a);
  return r;
}

}  // namespace

TEST_CASE("activity report: onset with its standard error and interval") {
  const ActivityResult r = one_video(true);
  const std::string page = activity_page(r);
  CHECK(test::XmlCheck::complaint(page) == "");
  CHECK(has(page, "0.500 ± 0.100"));
  CHECK(has(page, "standard error 0.100 s. (2) Maximum; standard error 0.0200 s"));
  const auto video = activity_json(r)["videos"][0];
  CHECK(video["onset_s"] == 0.5);
  CHECK(video["onset_ci90"][0].get<double>() == doctest::Approx(0.5 - 0.1645));
  CHECK(video["onset_ci90"][1].get<double>() == doctest::Approx(0.5 + 0.1645));
}

TEST_CASE("activity report: a failed fit has a reason and no onset, maximum or width") {
  const ActivityResult r = one_video(false);
  const std::string page = activity_page(r);
  CHECK(test::XmlCheck::complaint(page) == "");
  CHECK(has(page, "The Gaussian fit failed: the peak is wider than the video. No onset"));
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
