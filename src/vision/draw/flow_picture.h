#pragma once
#include <string>

#include "vision/flow/flow.h"

namespace faba {

/// How a flow is drawn.
struct FlowDrawing {
  double full_px = 0;  ///< flow drawn at full strength, px per pair; 0: the largest of 99.5 % of the pixels
  int arrow_step_px = 24;  ///< between arrows; 0: none
  bool key = true;         ///< the wheel of colours in the corner, with what its rim stands for
  std::string words = {};  ///< in the upper left corner
};

/// The flow in colours: the hue is the direction, the strength of the colour the speed, white is rest;
/// unknown (NaN) is grey. The circle of hues is spaced after the eye's, as in Baker et al. (2011). Same size
/// as the flow.
RgbImage draw_flow(const Flow& flow, const FlowDrawing& how = {});

/// A frame in grey with arrows for the flow, in the same colours; where the flow is less than a fifth of
/// `full_px` there is none. `frame` has the size of the flow, greys of 0 to 255.
RgbImage draw_flow_on(const GrayF& frame, const Flow& flow, const FlowDrawing& how = {});

/// Speed that the drawing shows at full strength when not given: 99.5 % of the pixels are slower.
double full_speed(const Flow& flow);

}  // namespace faba
