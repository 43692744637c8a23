#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "study/plot/curve_points.h"
#include "study/plot/plot_data.h"
#include "study/plot/plot_layers.h"

namespace faba::drawing {
namespace {

constexpr std::size_t kManyPoints = 1000;

std::string kind(const char* name) { return fmt::format(R"( data-kind="{}")", name); }

// Number of values, if some of them are not among the columns.
std::string thinned_from(std::size_t all, std::size_t kept) {
  return kept < all ? fmt::format(R"( data-of="{}")", all) : "";
}

std::string data(const Line& l, const Map& map) {
  std::vector<int> kept;
  std::size_t points = 0;
  for (const auto& section : curve_sections(l, map)) {
    if (!kept.empty()) kept.push_back(-1);
    for (const PlotPoint& p : section) kept.push_back(p.index);
    points += section.size();
  }
  std::size_t all = 0;
  for (std::size_t i = 0; i < std::min(l.x.size(), l.y.size()); ++i)
    all += std::isfinite(l.x[i]) && std::isfinite(l.y[i]);
  return kind(l.stairs ? "stairs" : "line") + data_attribute("x", data_column(l.x, kept)) +
         data_attribute("y", data_column(l.y, kept)) + thinned_from(all, points);
}

// Of many points, one of those that are drawn at the same place.
std::string data(const Scatter& s, const Map& map) {
  std::vector<int> kept;
  std::set<std::pair<std::int64_t, std::int64_t>> seen;
  const std::size_t n = std::min(s.x.size(), s.y.size());
  std::size_t all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
    ++all;
    const std::pair place(std::llround(2 * map.to_x(s.x[i])), std::llround(2 * map.to_y(s.y[i])));
    if (n <= kManyPoints || seen.insert(place).second) kept.push_back(int(i));
  }
  const char* mark = s.mark == Scatter::Mark::ring    ? "ring"
                     : s.mark == Scatter::Mark::cross ? "cross"
                                                      : "dot";
  return kind(mark) + data_attribute("x", data_column(s.x, kept)) +
         data_attribute("y", data_column(s.y, kept)) + thinned_from(all, kept.size());
}

template <class Interval>
std::string intervals(const char* name, const Interval& r) {
  std::vector<int> kept;
  bool gap = false;
  for (std::size_t i = 0; i < std::min({r.x.size(), r.lo.size(), r.hi.size()}); ++i) {
    const bool point = std::isfinite(r.x[i] + r.lo[i] + r.hi[i]);
    if (point && gap && !kept.empty()) kept.push_back(-1);
    if (point) kept.push_back(int(i));
    gap = !point;
  }
  return kind(name) + data_attribute("x", data_column(r.x, kept)) +
         data_attribute("lo", data_column(r.lo, kept)) + data_attribute("hi", data_column(r.hi, kept));
}
std::string data(const Ribbon& r, const Map&) { return intervals("ribbon", r); }
std::string data(const ErrorBars& e, const Map&) { return intervals("bars", e); }

// Layers without a list of points have their numbers in one attribute.
std::string shape(const char* name, std::initializer_list<double> numbers) {
  std::string text;
  for (const double v : numbers) {
    if (!std::isfinite(v)) return kind(name);
    text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", v);
  }
  return kind(name) + fmt::format(R"( data-at="{}")", text);
}
std::string data(const Band& b, const Map&) { return shape(b.of_x ? "band-x" : "band-y", {b.lo, b.hi}); }
std::string data(const Rule& r, const Map&) { return shape(r.of_x ? "rule-x" : "rule-y", {r.at}); }
std::string data(const Ellipse& e, const Map&) {
  return shape("ellipse", {e.x, e.y, e.radius_x, e.radius_y});
}
std::string data(const Box& b, const Map&) { return shape("box", {b.x0, b.y0, b.x1, b.y1}); }

}  // namespace

std::string layer_data(const Plot::Layer& layer, const Map& map) {
  return std::visit([&](const auto& l) { return data(l, map); }, layer);
}

}  // namespace faba::drawing
