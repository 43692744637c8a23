#include "study/steering/polyline.h"

#include <algorithm>
#include <cstddef>

// Boost 1.74 includes its own deprecated headers and warns about each.
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

namespace faba {
namespace {

using RoutePoint = boost::geometry::model::d2::point_xy<double>;
using RouteSegment = boost::geometry::model::segment<RoutePoint>;

std::vector<RouteSegment> segments_between(const std::vector<Vec2>& vertex) {
  std::vector<RouteSegment> out;
  for (std::size_t i = 0; i + 1 < vertex.size(); ++i)
    out.push_back({{vertex[i].x, vertex[i].y}, {vertex[i + 1].x, vertex[i + 1].y}});
  return out;
}

double segment_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 ab = b - a;
  const double square = dot(ab, ab);
  const double along = square > 0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0;
  return norm(p - (a + along * ab));
}

}  // namespace

struct Polyline::Tree {
  explicit Tree(const std::vector<Vec2>& vertex) : segments(segments_between(vertex)) {}
  boost::geometry::index::rtree<RouteSegment, boost::geometry::index::linear<16>> segments;
};

Polyline::Polyline(const std::vector<Vec2>& vertex) : tree_(new Tree(vertex)) {}
Polyline::~Polyline() = default;

double Polyline::distance(Vec2 p) const {
  RouteSegment nearest;
  tree_->segments.query(boost::geometry::index::nearest(RoutePoint(p.x, p.y), 1), &nearest);
  return segment_distance(p, {nearest.first.x(), nearest.first.y()},
                          {nearest.second.x(), nearest.second.y()});
}

}  // namespace faba
