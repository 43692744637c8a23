#pragma once
#include "study/identify/response_video.h"

namespace faba {

/// Sets cell_px and contrast of a video so that a rendered picture, of cells where `frame` shows some, has
/// cells as wide and as strong as those of `frame`, by the same measure. Everything else that is needed to
/// render must be there.
void match_look(ResponseVideo& v, const GrayF& frame, Boundary boundary);

}  // namespace faba
