#include "study/plot/curve_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace faba::drawing {
namespace {

/// First, lowest, highest and last point of every pixel column, in the order of the curve.
std::vector<PlotPoint> thinned_by_column(const std::vector<PlotPoint>& all) {
  std::vector<PlotPoint> kept;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t end = first + 1, lowest = first, highest = first;
    for (; end < all.size() && std::floor(all[end].x) == std::floor(all[first].x); ++end) {
      if (all[end].y < all[lowest].y) lowest = end;
      if (all[end].y > all[highest].y) highest = end;
    }
    std::array<std::size_t, 4> pick{first, std::min(lowest, highest), std::max(lowest, highest), end - 1};
    const auto stop = std::unique(pick.begin(), pick.end());
    for (auto i = pick.begin(); i != stop; ++i) kept.push_back(all[*i]);
    first = end;
  }
  return kept;
}

/// For a curve with non-monotonic x: drops points nearer than half a unit to the previous kept point.
std::vector<PlotPoint> thinned_by_distance(const std::vector<PlotPoint>& all) {
  std::vector<PlotPoint> kept{all.front()};
  for (const PlotPoint& p : all) {
    if (std::hypot(p.x - kept.back().x, p.y - kept.back().y) >= 0.5) kept.push_back(p);
  }
  return kept;
}

/// Drops points left and right of a drawing area of width `w`, except the neighbours of the visible points.
void crop(std::vector<PlotPoint>& forward, double w) {
  const auto left_of = [](double edge) { return [edge](const PlotPoint& p) { return p.x < edge; }; };
  const auto end = std::partition_point(forward.begin(), forward.end(), left_of(w));
  if (end != forward.end()) forward.erase(end + 1, forward.end());
  const auto begin = std::partition_point(forward.begin(), forward.end(), left_of(0));
  if (begin != forward.begin()) forward.erase(forward.begin(), begin - 1);
}

void finish(std::vector<PlotPoint>& section, double w) {
  const auto back = [](PlotPoint a, PlotPoint b) { return b.x < a.x; };
  const bool forward = std::adjacent_find(section.begin(), section.end(), back) == section.end();
  if (forward) crop(section, w);
  if (double(section.size()) > 4 * w)
    section = forward ? thinned_by_column(section) : thinned_by_distance(section);
}

}  // namespace

std::vector<std::vector<PlotPoint>> curve_sections(const Line& line, const Map& map) {
  std::vector<std::vector<PlotPoint>> sections;
  bool gap = true;
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
    const bool point = std::isfinite(line.x[i]) && std::isfinite(line.y[i]);
    if (point && gap) sections.emplace_back();
    if (point) sections.back().push_back({map.to_x(line.x[i]), map.to_y(line.y[i]), int(i)});
    gap = !point;
  }
  for (auto& section : sections) finish(section, map.w);
  return sections;
}

}  // namespace faba::drawing
