#pragma once
#include <span>
#include <vector>

#include "core/vec.h"

namespace faba {

/// A region that the swarm must not enter; corners in order, of either direction, world frame, m.
using Polygon = std::vector<Vec2>;

double area(const Polygon& polygon);  ///< m^2, of a polygon that does not cross itself

/// The point of a polygon's boundary nearest to a point.
struct NearestEdge {
  Vec2 at = {};
  Vec2 outward = {};    ///< unit vector away from the polygon
  double distance = 0;  ///< m, negative inside
};
NearestEdge nearest_edge(const Polygon& polygon, Vec2 p);

/// Whether the segment from a to b passes through a polygon.
bool crosses(const Polygon& polygon, Vec2 a, Vec2 b);

/// The shortest path from `from` to `to` that keeps a distance of `clearance` from all polygons: the points
/// after `from`, ending with `to`. Only `to` if nothing is in the way, or if there is no path.
std::vector<Vec2> shortest_path(std::span<const Polygon> polygons, Vec2 from, Vec2 to, double clearance);

}  // namespace faba
