#include "study/drop/drop_warnings.h"

#include <fmt/format.h>

namespace faba {
namespace {

// Assumed.
constexpr double kIncomplete = 0.8;   // fraction of the visible arc with an edge; below 0.65 it is refused
constexpr double kBlurredEdge = 0.1;  // width of the edge over the radius
constexpr double kOutOfRound = 0.03;  // half the difference of the axes over the radius

}  // namespace

std::vector<Warning> drop_warnings(const DropEdge& e) {
  std::vector<Warning> out;
  const double relative = e.sd_radius_px / e.radius_px;
  if (relative > kUncertainRadius)
    out.push_back({"radius", "the visible arc does not determine the radius well",
                   fmt::format("{:.3g} +- {:.2g} px, standard error; {:.0f} degrees are visible", e.radius_px,
                               e.sd_radius_px, e.arc_deg),
                   "use a picture that shows more of the edge",
                   relative > kUselessRadius ? Quality::poor : Quality::doubtful});
  else if (e.arc_deg < kShortArc)
    out.push_back({"arc",
                   "only a short arc of the edge is visible: an edge that is not exactly circular gives "
                   "another radius",
                   fmt::format("{:.0f} degrees", e.arc_deg), "use a picture that shows more of the edge"});
  if (e.support < kIncomplete)
    out.push_back({"outline",
                   "the edge was detected along a part of the visible arc only: other structures of "
                   "the picture may be included",
                   fmt::format("{:.0f} % of the arc", 100 * e.support), "check the edge with --overlay"});
  if (e.other)
    out.push_back(
        {"edges", "the picture has another circular edge",
         fmt::format("radius {:.4g} px about ({:.4g}, {:.4g}); the reported one is longer or clearer",
                     e.other->radius, e.other->centre.x, e.other->centre.y),
         "check with --overlay which of them is the edge of the drop; crop or mask the other one"});
  if (e.out_of_round_px > kOutOfRound * e.radius_px)
    out.push_back({"shape", "the edge is not a circle",
                   fmt::format("its half axes differ from the radius by {:.2g} px", e.out_of_round_px),
                   "use the radius as a mean value only"});
  if (e.edge_width_px > kBlurredEdge * e.radius_px)
    out.push_back({"focus", "the edge is blurred",
                   fmt::format("its width is {:.2g} px, the radius {:.3g} px", e.edge_width_px, e.radius_px),
                   "focus on the edge of the drop"});
  return out;
}

}  // namespace faba
