#pragma once
#include <vector>

#include "vision/flow/flow.h"

namespace faba {

/// What is kept of a flow before it is compared (theory A17).
struct FlowFilter {
  double threshold_px = 0;   ///< slower flow is noise, px per pair
  double direction_deg = 0;  ///< image frame: 0 right, 90 down
};

/// Sums of a flow over columns (x) and rows (y), bins all 0 or more.
struct FlowHistograms {
  /// Legacy: of |u| over columns and of |v| over rows, of the pixels whose flow is within 45 degrees of the
  /// direction.
  std::vector<double> x, y;
  /// Signed: of u > 0, u < 0 over columns and v > 0, v < 0 over rows, of all pixels above the threshold.
  std::vector<double> right, left, down, up;
};
/// `scale` multiplies all flows, as when frames of two videos are not equally far apart.
void flow_histograms(const Flow& flow, const FlowFilter& filter, double scale, FlowHistograms& out);

/// The flow that the legacy histograms are made of; the rest is zero.
Flow kept_flow(const Flow& flow, const FlowFilter& filter);

}  // namespace faba
