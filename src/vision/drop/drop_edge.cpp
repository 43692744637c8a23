#include "vision/drop/drop_edge.h"

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
  d.sd_radius_px = std::sqrt(c.fit.sd_radius * c.fit.sd_radius + systematic * systematic);
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
  return edge;
}

}  // namespace faba
