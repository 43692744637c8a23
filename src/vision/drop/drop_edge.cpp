#include "vision/drop/drop_edge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "vision/drop/drop_picture.h"
#include "vision/drop/drop_search.h"
#include "vision/drop/drop_side.h"

namespace faba {
namespace {

/// Systematic uncertainty of the edge position: a tenth of its width (half level, steepest point, centre of a
/// line) and a twentieth of a pixel.
double position_sd(double width) { return std::sqrt(0.1 * width * 0.1 * width + 0.05 * 0.05); }

DropEdge describe(const DropCandidate& c, const GrayF& picture, const DropPicture& prepared,
                  const DropEdgeOptions& o) {
  DropEdge d;
  d.centre_image = c.circle.centre;
  d.radius_px = c.circle.radius;
  d.edge_width_px = c.profile.width * c.scale;
  const double systematic = position_sd(d.edge_width_px);
  d.sd_centre_px = c.fit.sd_centre;
  d.out_of_round_px = c.out_of_round_px;
  // Standard deviation of the radius along an ellipse: its amplitude over the square root of two.
  d.sd_radius_px = std::sqrt(c.fit.sd_radius * c.fit.sd_radius + systematic * systematic +
                             c.out_of_round_px * c.out_of_round_px / 2);
  d.arc_deg = c.seen_rad * 180 / std::numbers::pi;
  d.image_width = picture.width;
  d.image_height = picture.height;
  d.support = c.evidence.support;
  d.log10_false_alarms = c.evidence.log10_false_alarms;
  d.edge_points = c.points;
  d.centre_side_inside = o.side == DropSide::centre;
  if (o.side == DropSide::automatic)
    d.centre_side_inside = !cells_only_outside(prepared.levels[0].grey, c.circle, 12 + 3 * d.edge_width_px);
  d.inside_image = point_on_side(picture.width, picture.height, c.circle, d.centre_side_inside);
  const bool line = c.profile.shape == EdgeShape::ring;
  d.contrast = (line                   ? c.profile.ring
                : d.centre_side_inside ? -c.profile.step
                                       : c.profile.step) /
               prepared.gain;
  return d;
}

/// The picture without an edge: minus the fitted step and line. `gain`: grey of the profile per grey of the
/// picture.
GrayF without_edge(const GrayF& picture, const DropCandidate& c, double gain) {
  const double width = c.profile.width * c.scale;
  GrayF rest = picture;
  for (int row = 0; row < rest.height; ++row)
    for (int col = 0; col < rest.width; ++col) {
      const double off = norm(Vec2{double(col), double(row)} - c.circle.centre) - c.circle.radius;
      const double t = off / width;
      const double step = c.profile.step * 0.5 * std::erfc(-t / std::numbers::sqrt2);
      rest.at(col, row) -= float((step + c.profile.ring * std::exp(-0.5 * t * t)) / gain);
    }
  return rest;
}

/// Another circular edge than `c`, detected in the picture without it.
std::optional<Circle> other_edge(const GrayF& picture, const DropCandidate& c, double gain,
                                 const DropEdgeOptions& o) {
  std::optional<DropCandidate> other;
  try {
    other = search_drop_edge(prepare_drop_picture(without_edge(picture, c, gain), o), o).accepted;
  } catch (const Error&) {
    return std::nullopt;  // the rest is uniform
  }
  if (!other) return std::nullopt;
  // What remains of the edge, where its contrast or width varies along it, is not another one.
  const double apart = std::max(6 * std::max(c.scale, other->scale), 4 * c.profile.width * c.scale);
  const auto off = [](const Circle& circle, Vec2 p) { return norm(p - circle.centre) - circle.radius; };
  for (Vec2 p : other->points)
    if (std::fabs(off(c.circle, p) - off(other->circle, p)) > apart) return other->circle;
  return std::nullopt;
}

}  // namespace

DropEdge find_drop_edge(const GrayF& picture, const DropEdgeOptions& options) {
  const DropPicture prepared = prepare_drop_picture(picture, options);
  DropSearch search = search_drop_edge(prepared, options);
  if (!search.accepted && search.rejected) throw Error(Errc::input, options.name, search.rejected->rejection);
  if (!search.accepted)
    throw Error(Errc::input, options.name,
                "no drop edge detected: the picture has no arc or line with sufficient contrast; check focus "
                "and light, "
                "and that the edge is in view");
  DropEdge edge = describe(*search.accepted, picture, prepared, options);
  edge.segments = std::move(search.segments);
  edge.other = other_edge(picture, *search.accepted, prepared.gain, options);
  return edge;
}

}  // namespace faba
