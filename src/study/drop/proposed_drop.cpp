#include "study/drop/proposed_drop.h"

#include <algorithm>

#include "core/error.h"

namespace faba {

ProposedDrop propose_drop(const GrayF& picture, const std::string& name) {
  constexpr double kRadius = 0.4;  // fraction of the smaller side
  const double w = picture.width, h = picture.height;
  ProposedDrop p;
  p.centre_image = {(w - 1) / 2, (h - 1) / 2};
  p.radius_px = kRadius * std::min(w, h);
  p.image_width = picture.width;
  p.image_height = picture.height;
  DropEdgeOptions options;
  options.name = name;
  try {
    p.edge = find_drop_edge(picture, options);
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;
    p.reason = e.reason();
    return p;
  }
  p.found = p.edge->centre_side_inside;
  if (!p.found) p.reason = "shows an air bubble in the liquid, not a drop";
  p.centre_image = p.edge->centre_image;
  p.radius_px = p.edge->radius_px;
  return p;
}

}  // namespace faba
