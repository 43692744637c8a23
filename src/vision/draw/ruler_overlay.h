#pragma once
#include "vision/image/image.h"
#include "vision/ruler/ruler.h"

namespace faba {

/// The picture (see read_displayed()) with the measured ruler marks: a light blue line over one half of each
/// mark, so that the other half shows the alignment; yellow with its number (counted from the first) for
/// every tenth mark; orange for marks excluded from the fit. Same size as the picture.
RgbImage ruler_overlay(const RgbImage& picture, const Ruler& ruler);

}  // namespace faba
