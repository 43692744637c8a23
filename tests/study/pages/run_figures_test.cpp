#include "study/pages/run_figures.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("run figures: only a short approach has a separate figure") {
  const auto headings = [](int frames) {
    std::vector<double> t, d, zero(std::size_t(frames), 0.0);
    for (int k = 0; k < frames; ++k) {
      t.push_back(k / 15.0);
      d.push_back(k < 30 ? 300 - 10 * k : 1);
    }
    const faba::Series series("series.csv",
                              {"t_s", "distance_px", "true_centroid_x_px", "true_centroid_y_px",
                               "true_sigma_x_px", "true_sigma_y_px", "true_rms_radius_px"},
                              {t, d, zero, zero, zero, zero, zero});
    std::string all;
    for (const faba::Figure& f : run_figures(series, control_metrics(series), {})) all += f.heading + ";";
    return all;
  };
  CHECK(has(headings(900), "Approach;"));
  CHECK_FALSE(has(headings(90), "Approach;"));
}

TEST_CASE("run figures: a command that switches too fast is plotted as mean and range") {
  const auto drawn = [](int half_period) {
    std::vector<double> t, current, zero(600, 0.0);
    for (int k = 0; k < 600; ++k) {
      t.push_back(k / 60.0);
      current.push_back(k / half_period % 2 ? 1 : -1);
    }
    const faba::Series series("series.csv",
                              {"t_s", "distance_px", "true_centroid_x_px", "true_centroid_y_px",
                               "true_sigma_x_px", "true_sigma_y_px", "true_rms_radius_px", "current_0_a"},
                              {t, zero, zero, zero, zero, zero, zero, current});
    for (const faba::Figure& f : run_figures(series, control_metrics(series), {}))
      if (f.heading == "Coil currents") return f;
    return faba::Figure{};
  };
  const faba::Figure slow = drawn(60), fast = drawn(1);
  REQUIRE(slow.plot.layers.size() == 1);
  CHECK(std::get<faba::Line>(slow.plot.layers[0]).y.size() == 600);
  CHECK_FALSE(has(slow.caption, "too fast"));
  REQUIRE(fast.plot.layers.size() == 2);
  const auto& range = std::get<faba::Ribbon>(fast.plot.layers[0]);
  const auto& mean = std::get<faba::Line>(fast.plot.layers[1]);
  REQUIRE(range.x.size() == 60);
  for (std::size_t i = 0; i < 60; ++i) {
    CHECK(range.lo[i] == -1);
    CHECK(range.hi[i] == 1);
    CHECK(mean.y[i] == 0);
  }
  CHECK(has(fast.caption, "means over 0.167 s"));
}
