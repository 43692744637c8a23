#include "control/plan/obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faba {
namespace {

double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

Vec2 unit(Vec2 v) {
  const double n = norm(v);
  return n > 0 ? (1 / n) * v : Vec2{1, 0};
}

double signed_area(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += cross(p[i], p[(i + 1) % p.size()]);
  return sum / 2;
}

Vec2 nearest_on(Vec2 a, Vec2 b, Vec2 p) {
  const Vec2 along = b - a;
  const double length = dot(along, along);
  const double t = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0.0;
  return a + t * along;
}

bool contains(const Polygon& polygon, Vec2 p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2 a = polygon[i], b = polygon[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

// Corners moved outwards along their bisectors, at convex corners only: a shortest path bends nowhere else.
std::vector<Vec2> corners_around(const Polygon& polygon, double clearance) {
  std::vector<Vec2> corners;
  const double turn = signed_area(polygon) > 0 ? 1 : -1;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = unit(polygon[i] - polygon[(i + n - 1) % n]),
               out = unit(polygon[(i + 1) % n] - polygon[i]);
    if (turn * cross(in, out) <= 0) continue;
    const Vec2 outward = unit(in - out);
    const double half = std::sqrt(std::max(0.0, (1 + dot(in, out)) / 2));  // cosine of half the turn
    // At a sharp corner the path is cut at twice the clearance.
    corners.push_back(polygon[i] + (clearance / std::max(half, 0.5)) * outward);
  }
  return corners;
}

bool free(std::span<const Polygon> polygons, Vec2 a, Vec2 b) {
  return std::none_of(polygons.begin(), polygons.end(), [&](const Polygon& p) { return crosses(p, a, b); });
}

}  // namespace

double area(const Polygon& polygon) { return std::fabs(signed_area(polygon)); }

NearestEdge nearest_edge(const Polygon& polygon, Vec2 p) {
  NearestEdge nearest{.distance = std::numeric_limits<double>::infinity()};
  Vec2 along;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const Vec2 at = nearest_on(a, b, p);
    const double distance = norm(p - at);
    if (distance >= nearest.distance) continue;
    nearest.distance = distance;
    nearest.at = at;
    along = b - a;
  }
  const double turn = signed_area(polygon) > 0 ? 1 : -1;
  if (contains(polygon, p)) {
    nearest.outward = unit(nearest.at - p);
    nearest.distance = -nearest.distance;
  } else if (nearest.distance > 0) {
    nearest.outward = unit(p - nearest.at);
  } else {
    nearest.outward = unit({turn * along.y, -turn * along.x});
  }
  return nearest;
}

bool crosses(const Polygon& polygon, Vec2 a, Vec2 b) {
  if (contains(polygon, 0.5 * (a + b))) return true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 c = polygon[i], d = polygon[(i + 1) % polygon.size()];
    const double ac = cross(b - a, c - a), ad = cross(b - a, d - a);
    const double ca = cross(d - c, a - c), cb = cross(d - c, b - c);
    if (ac * ad < 0 && ca * cb < 0) return true;
  }
  return false;
}

// Dijkstra's algorithm on the graph of the corners that see each other.
std::vector<Vec2> shortest_path(std::span<const Polygon> polygons, Vec2 from, Vec2 to, double clearance) {
  if (free(polygons, from, to)) return {to};
  std::vector<Vec2> points{from, to};
  for (const Polygon& p : polygons)
    for (const Vec2 corner : corners_around(p, clearance))
      if (std::none_of(polygons.begin(), polygons.end(),
                       [&](const Polygon& q) { return contains(q, corner); }))
        points.push_back(corner);
  const std::size_t n = points.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> length(n, kInfinity);
  std::vector<std::size_t> before(n, n);
  std::vector<bool> done(n, false);
  length[0] = 0;
  for (;;) {
    std::size_t at = n;
    for (std::size_t i = 0; i < n; ++i)
      if (!done[i] && length[i] < (at < n ? length[at] : kInfinity)) at = i;
    if (at == n || at == 1) break;
    done[at] = true;
    for (std::size_t i = 0; i < n; ++i) {
      const double through = length[at] + norm(points[i] - points[at]);
      if (done[i] || through >= length[i] || !free(polygons, points[at], points[i])) continue;
      length[i] = through;
      before[i] = at;
    }
  }
  if (before[1] == n) return {to};
  std::vector<Vec2> path;
  for (std::size_t i = 1; i != 0; i = before[i]) path.push_back(points[i]);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace faba
