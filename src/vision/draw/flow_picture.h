#pragma once
#include <string>

#include "vision/flow/flow.h"

namespace faba {

/// Options of flow pictures.
struct FlowDrawing {
  double full_px = 0;  ///< flow at full colour saturation, px per pair; 0: 99.5 % percentile (full_speed())
  int arrow_step_px = 24;  ///< distance between arrows; 0: no arrows
  bool key = true;         ///< colour wheel in the corner, labelled with the value of its rim
  std::string words = {};  ///< text in the upper left corner
};

/// Flow as colours: hue is the direction, saturation the speed, white is zero flow, grey is unknown (NaN).
/// Colour wheel of Baker et al. (2011). Same size as the flow.
RgbImage draw_flow(const Flow& flow, const FlowDrawing& how = {});

/// A grey frame with flow arrows in the same colours; no arrows where the flow is below a fifth of `full_px`.
/// `frame` has the size of the flow and grey values 0 to 255.
RgbImage draw_flow_on(const GrayF& frame, const Flow& flow, const FlowDrawing& how = {});

/// Default of full_px: 99.5 % percentile of the speed.
double full_speed(const Flow& flow);

}  // namespace faba
