#include "vision/drop/drop_edge.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "vision/drop/drop_picture.h"
#include "vision/drop/drop_search.h"
#include "vision/drop/drop_side.h"

namespace faba {
namespace {

/// The place of an edge is a matter of definition to about a tenth of its width (half level, steepest, middle
/// of a line), and of pixels to a twentieth.
double place_sd(double width) { return std::sqrt(0.1 * width * 0.1 * width + 0.05 * 0.05); }

DropEdge describe(const DropCandidate& c, const GrayF& picture, const DropPicture& prepared,
                  const DropEdgeOptions& o) {
  DropEdge d;
  d.centre_image = c.circle.centre;
  d.radius_px = c.circle.radius;
  d.edge_width_px = c.profile.width * c.scale;
  const double place = place_sd(d.edge_width_px);
  d.sd_centre_px = c.fit.sd_centre;
  d.sd_radius_px = std::sqrt(c.fit.sd_radius * c.fit.sd_radius + place * place);
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
  if (!search.accepted && search.refused) throw Error(Errc::input, options.name, search.refused->objection);
  if (!search.accepted)
    throw Error(
        Errc::input, options.name,
        "no edge of a drop: nothing in the picture stands out along an arc or a line; check focus and light, "
        "and that the edge is in view");
  DropEdge edge = describe(*search.accepted, picture, prepared, options);
  edge.segments = std::move(search.segments);
  return edge;
}

}  // namespace faba
