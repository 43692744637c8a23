#include "study/plot/plot_svg.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/study/well_formed.h"

namespace {

using namespace faba;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// No std::regex on complete drawings: its recursion overflows the stack on long path data.

/// Text between the first `before` and the next `after`; empty without `before`.
std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const auto at = text.find(before);
  if (at == std::string::npos) return {};
  const auto begin = at + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}

/// Path data of the first <path> with this class.
std::string path_of(const std::string& svg, const std::string& look) {
  return between(between(svg, "<path class=\"s-" + look + "\"", "/>"), " d=\"", "\"");
}

struct Corner {
  double x, y;
};
/// The points of path data that has only M and L.
std::vector<Corner> corners(std::string path) {
  std::replace_if(
      path.begin(), path.end(), [](char c) { return c == 'M' || c == 'L'; }, ' ');
  std::istringstream numbers(path);
  std::vector<Corner> out;
  for (Corner c{}; numbers >> c.x >> c.y;) out.push_back(c);
  return out;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// The drawing without the codes of its values, which are letters.
std::string without_columns(std::string svg) {
  for (const char* name : {" data-x=\"", " data-y=\"", " data-lo=\"", " data-hi=\""})
    for (auto at = svg.find(name); at != std::string::npos; at = svg.find(name, at))
      svg.erase(at, svg.find('"', at + std::string(name).size()) + 1 - at);
  return svg;
}

/// True when a number was printed as nan or inf; "information" is not one.
bool has_nan_or_inf(const std::string& drawing) {
  const std::string svg = without_columns(drawing);
  for (const char* word : {"nan", "inf"}) {
    for (auto at = svg.find(word); at != std::string::npos; at = svg.find(word, at + 1)) {
      const auto lower = [&](std::size_t i) {
        return i < svg.size() && std::islower(static_cast<unsigned char>(svg[i]));
      };
      if (!lower(at - 1) && !lower(at + 3)) return true;
    }
  }
  return false;
}

void check_sound(const std::string& svg) {
  CHECK(test::XmlCheck::complaint(svg) == "");
  CHECK_FALSE(has_nan_or_inf(svg));
}

/// A plot with one layer of every kind.
Plot everything() {
  Plot plot;
  plot.title = "All of it";
  plot.x.label = "time (s)";
  plot.y.label = "distance (px)";
  plot.right = SecondScale{0.8, "distance (µm)"};
  plot.add(Band{0, 16, "band"});
  plot.add(Line{{0, 1, 2, 3}, {5, kNan, 40, 30}, "distance"});
  plot.add(Line{{0, 1, 2, 3}, {1, 2, 3, 4}, "stairs", Ink::automatic, true, true});
  plot.add(Scatter{{0, 1, 2}, {3, kInfinite, 9}, "dots"});
  plot.add(Scatter{{0.5}, {3}, "ring", Ink::green, Scatter::Mark::ring});
  plot.add(Scatter{{0.7}, {3}, "cross", Ink::green, Scatter::Mark::cross});
  plot.add(Rule{1.5, "settled"}).add(Rule{22, "level", false});
  plot.add(Ellipse{1, 20, 0.5, 8, "drop"}).add(Box{0.2, 3, 2.5, 37, "walls"});
  return plot;
}

}  // namespace

TEST_CASE("plot: a plot with every kind of layer is well-formed and has its labels") {
  const std::string drawing = svg(everything());
  check_sound(drawing);
  for (const char* words : {"All of it", "time (s)", "distance (px)", "distance (µm)", ">band<", ">stairs<",
                            ">settled<", ">level<", ">drop<", ">walls<", "prefers-color-scheme:dark"}) {
    CHECK_MESSAGE(drawing.find(words) != std::string::npos, words);
  }
  CHECK(drawing.find("<script") == std::string::npos);
  CHECK(drawing.find("href") == std::string::npos);
}

TEST_CASE("plot: the XML check of these tests detects errors") {
  for (const char* bad : {"<a>", "<a></b>", "<a b=c/>", "<a b=\"1\" b=\"2\"/>", "<a>x & y</a>", "<a/><b/>",
                          "<a b=\"<\"/>", "words", "<a b=\"1\"c=\"2\"/>", "<a"}) {
    CHECK_MESSAGE(test::XmlCheck::complaint(bad) != "", bad);
  }
  CHECK(test::XmlCheck::complaint("<a b=\"1\"><c/>x &amp; y</a>") == "");
  CHECK(has_nan_or_inf("<path d=\"M1.0 nan\"/>"));
  CHECK(has_nan_or_inf("<rect x=\"-inf\"/>"));
  CHECK_FALSE(has_nan_or_inf("<text>information on nanometres</text>"));
}

TEST_CASE("plot: all texts are escaped") {
  Plot plot = everything();
  const std::string hostile = "</text><script>alert(\"1\")</script>&'";
  plot.title = plot.description = plot.x.label = plot.y.label = plot.right->label = hostile;
  plot.add(Line{{0, 1}, {0, 1}, hostile}).add(Rule{1, hostile}).add(Band{0, 1, hostile});
  const std::string drawing = svg(plot);
  check_sound(drawing);
  CHECK(drawing.find("<script") == std::string::npos);
  CHECK(count(drawing, "&lt;script&gt;") == 8);
}

TEST_CASE("plot: no data, one point, constant and extreme values give a well-formed drawing") {
  check_sound(svg(Plot()));
  CHECK(svg(Plot()).find("no data") != std::string::npos);
  const std::vector<std::vector<double>> hostile{{},
                                                 {3},
                                                 {5, 5, 5},
                                                 {0, 0},
                                                 {kNan, kNan},
                                                 {kInfinite, -kInfinite, 1},
                                                 {1e308, -1e308},
                                                 {1e99, -1e99},
                                                 {1e-320, 2e-320},
                                                 {1e15, 1e15 + 1},
                                                 {1e-12, 3e-12},
                                                 {-7e6, 3e8}};
  for (const auto& x : hostile) {
    for (const auto& y : hostile) {
      for (const bool equal : {false, true}) {
        Plot plot;
        plot.equal_aspect = equal;
        plot.right = SecondScale{1e-3, "other"};
        plot.add(Line{x, y, "line"}).add(Scatter{x, y, "dots"});
        plot.add(Ribbon{y, y, y});
        if (!y.empty()) plot.add(Band{y.front(), y.back()}).add(Rule{y.front(), "rule", false});
        if (x.size() > 1 && y.size() > 1) {
          plot.add(Ellipse{x[0], y[0], x[1], y[1]}).add(Box{x[0], y[0], x[1], y[1]});
        }
        const std::string drawing = svg(plot);
        REQUIRE(test::XmlCheck::complaint(drawing) == "");
        REQUIRE_FALSE(has_nan_or_inf(drawing));
        REQUIRE(drawing.size() < 30000);
      }
    }
  }
}

TEST_CASE("plot: configured ranges are kept; reversed limits give a well-formed drawing") {
  Plot plot;
  plot.add(Line{{0, 10}, {0, 5}});
  plot.y.lo = 8;
  plot.y.hi = 2;
  check_sound(svg(plot));
  plot.y.lo = 0;
  plot.y.hi = 100;
  const std::string drawing = svg(plot);
  CHECK(drawing.find(">100<") != std::string::npos);
}

TEST_CASE("plot: gaps interrupt the curve, and a point between two gaps is a dot") {
  Plot plot;
  plot.add(Line{{0, 1, 2, 3, 4, 5, 6}, {1, 2, kNan, 3, kNan, 2, 1}, "", Ink::blue});
  const std::string path = path_of(svg(plot), "blue");
  CHECK(count(path, "M") == 3);
  CHECK(count(path, "L") == 2);
  CHECK(count(path, "h0") == 1);
}

TEST_CASE("plot: a long series keeps the minimum and maximum of every pixel column") {
  // 200 000 points of a slow wave with one spike up and one down, each a single sample.
  const std::size_t n = 200000;
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = double(i);
    y[i] = std::sin(1e-4 * double(i)) + 0.2 * std::sin(double(i));
  }
  y[70001] = 9;
  y[130003] = -7;
  Plot plot;
  plot.y.lo = -10;
  plot.y.hi = 10;
  plot.add(Line{x, y, "", Ink::blue});
  const std::string drawing = svg(plot);
  check_sound(drawing);
  const std::vector<Corner> kept = corners(path_of(drawing, "blue"));
  CHECK(kept.size() <= 4 * std::size_t(plot.width));
  CHECK(kept.size() > 1000);

  // The y axis maps 20 units to the height of the drawing area, the nested <svg>.
  const std::string clip = drawing.substr(drawing.find("<svg", 4));
  const double w = std::stod(between(clip, "width=\"", "\"")),
               h = std::stod(between(clip, "height=\"", "\""));
  const auto by_y = [](Corner a, Corner b) { return a.y < b.y; };
  const Corner top = *std::min_element(kept.begin(), kept.end(), by_y);
  const Corner bottom = *std::max_element(kept.begin(), kept.end(), by_y);
  const double rounding = 0.11;  // coordinates and the clip have one decimal each
  CHECK(std::abs(top.y - h * 1 / 20) <= rounding);
  CHECK(std::abs(top.x - w * 70001 / double(n - 1)) <= rounding);
  CHECK(std::abs(bottom.y - h * 17 / 20) <= rounding);
  CHECK(std::abs(bottom.x - w * 130003 / double(n - 1)) <= rounding);
  CHECK(std::is_sorted(kept.begin(), kept.end(), [](Corner a, Corner b) { return a.x < b.x; }));
}

TEST_CASE("plot: a curve with non-monotonic x is thinned by distance") {
  const std::size_t n = 100000;
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = 300 * std::cos(1e-3 * double(i));
    y[i] = 200 * std::sin(1e-3 * double(i));
  }
  Plot plot;
  plot.equal_aspect = true;
  plot.add(Line{x, y, "", Ink::blue});
  const std::string drawing = svg(plot);
  check_sound(drawing);
  // 15.9 turns of at most 2 pi * 230 units each, in steps of half a unit or more.
  const std::size_t kept = corners(path_of(drawing, "blue")).size();
  CHECK(kept > 1000);
  CHECK(kept <= std::size_t(15.9 * 2 * 3.1416 * 230 / 0.5) + 2);
}

TEST_CASE("plot: an enlarged part of a long series draws only this part and its neighbours") {
  const std::size_t n = 100000;
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = double(i);
    y[i] = double(i % 7);
  }
  Plot plot;
  plot.x.lo = 500;
  plot.x.hi = 510;
  plot.add(Line{x, y, "", Ink::blue});
  const std::string drawing = svg(plot);
  const std::vector<Corner> part = corners(path_of(drawing, "blue"));
  REQUIRE(part.size() >= 12);
  CHECK(part.size() <= 13);
  CHECK(part.front().x < 0);  // 499: the line starts left of the visible range
  CHECK(part.back().x >=
        std::stod(between(drawing.substr(drawing.find("<svg", 4)), "width=\"", "\"")) - 0.11);
}

TEST_CASE("plot: y points up, or down for a picture; equal units with equal_aspect") {
  Plot plot;
  plot.equal_aspect = true;
  plot.add(Line{{0, 300}, {0, 100}, "", Ink::blue});
  const std::vector<Corner> up = corners(path_of(svg(plot), "blue"));
  plot.y.reversed = true;
  const std::vector<Corner> down = corners(path_of(svg(plot), "blue"));
  REQUIRE(up.size() == 2);
  REQUIRE(down.size() == 2);
  CHECK(up[1].y < up[0].y);
  CHECK(down[1].y > down[0].y);
  // Coordinates have one decimal, so the error of each difference is at most 0.1.
  const double per_unit_x = (up[1].x - up[0].x) / 300, per_unit_y = (up[0].y - up[1].y) / 100;
  CHECK(std::abs(per_unit_x - per_unit_y) <= 0.1 / 100 + 0.1 / 300);
}

TEST_CASE("plot: a line with stairs has horizontal and vertical parts only") {
  Plot plot;
  plot.add(Line{{0, 1, 2}, {0, 5, 5}, "", Ink::blue, false, true});
  const std::string path = path_of(svg(plot), "blue");
  CHECK(count(path, "H") == 2);
  CHECK(count(path, "V") == 2);
  CHECK(path.find('L') == std::string::npos);
}

TEST_CASE("plot: ticks are round numbers inside the range") {
  CHECK(tick_positions(0, 10, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(tick_positions(-0.5, 639.5, 6) == std::vector<double>{0, 100, 200, 300, 400, 500, 600});
  CHECK(tick_positions(0, 26.6, 6) == std::vector<double>{0, 5, 10, 15, 20, 25});
  CHECK(tick_positions(3, 3, 5).empty());
  CHECK(tick_positions(5, 3, 5).empty());
  CHECK(tick_positions(kNan, 3, 5).empty());
  CHECK(tick_positions(0, kInfinite, 5).empty());
  for (double lo : {-1234.5, -1e-7, 0.0, 0.3, 98765.0}) {
    for (double length : {1e-9, 0.07, 1.0, 33.0, 4.4e8}) {
      const std::vector<double> ticks = tick_positions(lo, lo + length, 6);
      // With steps of 1, 2, 5 the number of ticks is between 0.5 and 1.5 times the requested one, plus or
      // minus one.
      CHECK(ticks.size() >= 3);
      CHECK(ticks.size() <= 10);
      // Ticks are multiples of a step, so rounding of lo / step can move them slightly outside.
      CHECK(ticks.front() >= lo - 1e-6 * length);
      CHECK(ticks.back() <= lo + length + 1e-6 * length);
    }
  }
}

TEST_CASE("plot: ticks of counts are integers, those of angles multiples of 45 degrees") {
  CHECK(tick_positions(0, 2.2, 6, Ticks::integers) == std::vector<double>{0, 1, 2});
  CHECK(tick_positions(0, 100, 5, Ticks::integers) == std::vector<double>{0, 20, 40, 60, 80, 100});
  CHECK(tick_positions(-180, 180, 8, Ticks::degrees) ==
        std::vector<double>{-180, -135, -90, -45, 0, 45, 90, 135, 180});
  CHECK(tick_positions(0, 360, 5, Ticks::degrees) == std::vector<double>{0, 90, 180, 270, 360});
  CHECK(tick_positions(80, 100, 5, Ticks::degrees) == std::vector<double>{80, 85, 90, 95, 100});
}

TEST_CASE("plot: error bars extend the axis and have caps; without values they are not drawn") {
  Plot plot;
  plot.add(ErrorBars{{1, 2, kNan}, {3, 4, 0}, {5, 90, 1}, "interval", Ink::green});
  CHECK(has_values(plot));
  const std::string drawing = svg(plot);
  check_sound(drawing);
  CHECK(drawing.find(">80<") != std::string::npos);
  CHECK(count(drawing, "<path class=\"s-green\"") == 2);  // the bars and the symbol of the legend
  CHECK_FALSE(has_values(Plot{}));
  Plot empty;
  empty.add(Band{0, 1}).add(Rule{2}).add(Line{{kNan}, {1}}).add(ErrorBars{{1}, {kNan}, {kNan}});
  CHECK_FALSE(has_values(empty));
}

TEST_CASE("plot: ticks of an axis have equal decimals; large and small numbers have a common power of ten") {
  Plot plot;
  plot.x.label = "time (s)";
  plot.y.label = "field (T)";
  plot.add(Line{{0, 1}, {-4e-5, 4e-5}});
  const std::string drawing = svg(plot);
  CHECK(drawing.find("field (T) ×10⁻⁵") != std::string::npos);
  CHECK(drawing.find(">\u22124<") != std::string::npos);
  CHECK(drawing.find(">0.0<") != std::string::npos);
  CHECK(drawing.find(">0.2<") != std::string::npos);
}

TEST_CASE("plot: automatic colours differ, and figures have no ids that could collide") {
  Plot plot;
  for (int i = 0; i < 6; ++i) plot.add(Line{{0, 1}, {0, double(i)}});
  const std::string drawing = svg(plot);
  for (const char* ink : {"blue", "vermillion", "green", "purple", "orange", "sky"}) {
    CHECK_MESSAGE(path_of(drawing, ink) != "", ink);
  }
  CHECK(drawing.find(" id=") == std::string::npos);
}

TEST_CASE("plot: an inlined drawing has no XML namespace, a file has it") {
  Plot plot;
  CHECK(svg(plot).find("xmlns=\"http://www.w3.org/2000/svg\"") != std::string::npos);
  plot.inlined = true;
  CHECK(svg(plot).find("http") == std::string::npos);
}

TEST_CASE("plot: the label of a vertical axis that is longer than the axis has two lines") {
  Plot plot;
  plot.y.label = "position along the segment (fraction of the view)";
  plot.right = SecondScale{2, "position along the segment (thousandths of the view)"};
  plot.add(Line{.x = {0, 1}, .y = {0, 1}});
  const std::string drawn = svg(plot);
  CHECK(drawn.find(">position along the segment</text>") != std::string::npos);
  CHECK(drawn.find(">(fraction of the view)</text>") != std::string::npos);
  CHECK(drawn.find(">(thousandths of the view)</text>") != std::string::npos);
  CHECK(count(drawn, "rotate(-90 -") == 0);  // no line is left of the figure
  plot.y.label = "position (px)";
  CHECK(count(svg(plot), ">position (px)</text>") == 1);
}
