#pragma once
#include <vector>

#include "vision/flow/flow.h"

namespace faba {

/// Filter of the flow before the comparison (theory A17).
struct FlowFilter {
  double threshold_px = 0;   ///< smaller flows are noise, px per pair
  double direction_deg = 0;  ///< image frame: 0 right, 90 down
};

/// Sums of a flow over columns (x) and rows (y); all bins are >= 0.
struct FlowHistograms {
  /// Legacy: of |u| over columns and of |v| over rows, for pixels whose flow is within 45 degrees of the
  /// direction.
  std::vector<double> x, y;
  /// Signed: of u > 0, u < 0 over columns and v > 0, v < 0 over rows, for all pixels above the threshold.
  std::vector<double> right, left, down, up;
};
/// `scale` multiplies all flows, to compare videos with different frame periods.
void flow_histograms(const Flow& flow, const FlowFilter& filter, double scale, FlowHistograms& out);

/// The flow used for the legacy histograms; all other flows are zero.
Flow filtered_flow(const Flow& flow, const FlowFilter& filter);

}  // namespace faba
