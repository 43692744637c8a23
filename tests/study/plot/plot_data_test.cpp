#include "study/plot/plot_data.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "study/plot/plot_svg.h"

namespace {

using namespace faba;
using drawing::data_column;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The values of a column, decoded as web/src/results/plot_data.ts does.
std::vector<double> decoded(const std::string& column) {
  std::istringstream in(column);
  double offset = 0, step = 0;
  int order = 0;
  std::string codes;
  in >> offset >> step >> order >> codes;
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<double> out;
  std::int64_t value = 0, last = 0, difference = 0;
  int shift = 0;
  for (const char c : codes) {
    if (c == '-') {
      out.push_back(kNan);
      continue;
    }
    const auto digit = std::int64_t(letters.find(c));
    value |= (digit & 31) << shift;
    shift += 5;
    if (digit & 32) continue;
    const std::int64_t d = value & 1 ? -(value >> 1) : value >> 1;
    const std::int64_t n = d + (order == 0 ? 0 : order == 1 ? last : last + difference);
    difference = n - last;
    last = n;
    out.push_back(offset + double(n) * step);
    value = 0;
    shift = 0;
  }
  return out;
}

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const auto at = text.find(before);
  if (at == std::string::npos) return {};
  const auto begin = at + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}
std::vector<double> numbers(std::string text) {
  for (char& c : text)
    if (c == 'M' || c == 'L' || c == 'H' || c == 'V') c = ' ';
  std::istringstream in(text);
  std::vector<double> out;
  for (double v = 0; in >> v;) out.push_back(v);
  return out;
}
/// Attributes of the group of the first layer.
std::string layer(const std::string& svg) { return between(svg, "<g data-layer=\"0\"", ">"); }

/// Whether each drawn point is at its value, within the rounding of the drawing.
void check_points(const std::string& svg) {
  const std::string area = svg.substr(svg.find("<svg", 4));
  const std::vector<double> x = decoded(between(layer(svg), "data-x=\"", "\"")),
                            y = decoded(between(layer(svg), "data-y=\"", "\""));
  const std::vector<double> ends_x = numbers(between(area, "data-x=\"", "\"")),
                            ends_y = numbers(between(area, "data-y=\"", "\""));
  const double w = std::stod(between(area, "width=\"", "\"")),
               h = std::stod(between(area, "height=\"", "\""));
  const std::vector<double> drawn = numbers(between(area.substr(area.find("<path")), " d=\"", "\""));
  REQUIRE(ends_x.size() == 2);
  REQUIRE(ends_y.size() == 2);
  std::vector<double> expected;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) continue;
    expected.push_back(w * (x[i] - ends_x[0]) / (ends_x[1] - ends_x[0]));
    expected.push_back(h * (1 - (y[i] - ends_y[0]) / (ends_y[1] - ends_y[0])));
  }
  REQUIRE(drawn.size() == expected.size());
  REQUIRE(drawn.size() > 3);
  // Points, width and height have one decimal each.
  for (std::size_t i = 0; i < drawn.size(); ++i) REQUIRE(std::abs(drawn[i] - expected[i]) <= 0.11);
}

}  // namespace

TEST_CASE("plot data: a column is offset, step, order and codes") {
  // 150, 225, missing and -300 hundredths; the same text is decoded in web/tests/plot_data.test.ts.
  CHECK(data_column({1.5, 2.25, kNan, -3}) == "0 1e-2 0 sJiO-5S");
  CHECK(data_column({0, 2, 4, 6}, {0, 1, -1, 3}) == "0 2 0 AC-G");
  CHECK(data_column({}) == "0 1e-8 0 ");
}

TEST_CASE("plot data: decoded values equal the data") {
  std::vector<double> noise, counts, small;
  for (int i = 0; i < 500; ++i) {
    noise.push_back(1e4 * std::sin(1.7 * i * i));
    counts.push_back((i * 7919) % 1000);
    small.push_back(1e-12 * std::cos(i));
  }
  noise[17] = kNan;
  noise[18] = std::numeric_limits<double>::infinity();
  const std::vector<double> back = decoded(data_column(noise));
  REQUIRE(back.size() == noise.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (std::isfinite(noise[i]))
      REQUIRE(std::abs(back[i] - noise[i]) <= 0.5e-6 * 1e5);  // the largest value has five digits
    else
      REQUIRE(std::isnan(back[i]));
  }
  CHECK(decoded(data_column(counts)) == counts);
  const std::vector<double> tiny = decoded(data_column(small));
  for (std::size_t i = 0; i < small.size(); ++i) REQUIRE(std::abs(tiny[i] - small[i]) <= 1e-17);
  // Nine digits for a short column.
  const std::vector<double> few = {3.14159265, 271.828183, -0.00123};
  const std::vector<double> same = decoded(data_column(few));
  for (std::size_t i = 0; i < few.size(); ++i) CHECK(std::abs(same[i] - few[i]) <= 0.5e-6);
}

TEST_CASE("plot data: extreme values do not overflow") {
  for (const double v : {1e308, 1e99, 1e-320, 0.0, -1e100})
    for (const double other : {1e-300, -1e99, 5.0}) {
      const std::vector<double> back = decoded(data_column({v, other}));
      REQUIRE(back.size() == 2);
      for (const double b : back) CHECK((std::isnan(b) || std::abs(b) <= 1.000001e99));
    }
}

TEST_CASE("plot data: evenly spaced times have their spacing as step, and one letter each") {
  std::vector<double> t, y;
  std::vector<int> kept;
  for (int i = 0; i < 300; ++i) {
    t.push_back(2.5 + i / 30.0);
    kept.push_back(i);
  }
  const std::string column = data_column(t, kept);
  CHECK(column.size() < 300 + 40);
  const std::vector<double> back = decoded(column);
  REQUIRE(back.size() == 300);
  for (std::size_t i = 0; i < t.size(); ++i) REQUIRE(std::abs(back[i] - t[i]) < 1e-9);
}

TEST_CASE("plot data: the attributes of a drawing give its points") {
  Line line{{}, {}, "signal", Ink::blue};
  for (int i = 0; i < 400; ++i) {
    line.x.push_back(i / 15.0);
    line.y.push_back(40 + 30 * std::sin(0.05 * i) + std::sin(3.1 * i * i));
  }
  Plot plot;
  plot.x.label = "time (s)";
  plot.add(line);
  const std::string drawing = svg(plot);
  check_points(drawing);
  CHECK(layer(drawing).find("data-of") == std::string::npos);
  CHECK(drawing.find("data-axis=\"x\">time (s)<") != std::string::npos);
  CHECK(drawing.find("<g data-legend=\"0\">") != std::string::npos);
  plot.x.reversed = plot.y.reversed = true;
  check_points(svg(plot));
  plot.y.logarithmic = true;
  check_points(svg(plot));
  CHECK(svg(plot).find("data-log=\"y\"") != std::string::npos);
  // The values cost less than two thirds of the drawn points.
  const std::string path = between(drawing.substr(drawing.find("data-layer")), " d=\"", "\"");
  CHECK(3 * layer(drawing).size() < 2 * path.size());
}

TEST_CASE("plot data: a thinned curve states the number of its points, and keeps those that are drawn") {
  Line line{{}, {}, "", Ink::blue};
  for (int i = 0; i < 50000; ++i) {
    line.x.push_back(i);
    line.y.push_back(std::sin(1e-3 * i) + 0.1 * std::sin(double(i)));
  }
  Plot plot;
  plot.add(line);
  const std::string drawing = svg(plot);
  check_points(drawing);
  CHECK(between(layer(drawing), "data-of=\"", "\"") == "50000");
}

TEST_CASE("plot data: points that are drawn at the same place are among the values") {
  Plot plot;
  plot.add(Scatter{{1, 1, 2, kNan, 3}, {5, 5.000001, 7, 1, 9}, "", Ink::blue});
  const std::string drawing = svg(plot);
  CHECK(decoded(between(layer(drawing), "data-x=\"", "\"")) == std::vector<double>{1, 1, 2, 3});
  const std::vector<double> y = decoded(between(layer(drawing), "data-y=\"", "\""));
  REQUIRE(y.size() == 4);
  CHECK(std::abs(y[1] - 5.000001) < 1e-8);
}

TEST_CASE("plot data: intervals and outlines have their numbers") {
  Plot plot;
  plot.add(ErrorBars{{1, 2}, {3, kNan}, {5, 90}, "", Ink::green});
  plot.add(Rule{1.5, "settled"}).add(Band{0.25, 16}).add(Ellipse{1, 20, 0.5, 8}).add(Box{0.5, 3, 2.5, 37});
  plot.right = SecondScale{0.8, "distance (µm)", 2};
  const std::string drawing = svg(plot);
  CHECK(decoded(between(layer(drawing), "data-lo=\"", "\"")) == std::vector<double>{3});
  for (const char* text : {"data-kind=\"rule-x\" data-at=\"1.5\"", "data-kind=\"band-y\" data-at=\"0.25 16\"",
                           "data-kind=\"ellipse\" data-at=\"1 20 0.5 8\"",
                           "data-kind=\"box\" data-at=\"0.5 3 2.5 37\"", "data-right=\"0.8 2\""})
    CHECK_MESSAGE(drawing.find(text) != std::string::npos, text);
}
