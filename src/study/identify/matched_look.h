#pragma once
#include "study/identify/response_video.h"

namespace faba {

/// Sets `cell_px` and `contrast` of a video such that cells in a rendered frame have the same median width
/// and integrated grey value as the cells in `frame`, measured by the same detector. All other data for
/// rendering must be set before.
void match_look(ResponseVideo& v, const GrayF& frame, Boundary boundary);

}  // namespace faba
