#pragma once
#include "vision/image/image.h"
#include "vision/ruler/ruler.h"

namespace faba {

/// The picture in grey with the marks that were measured drawn on it: a light blue line over the half of each
/// mark, so that the other half shows whether it lies right, yellow for every tenth one with its number,
/// counted from the first, and orange for marks that the fit left out. Same size as the picture.
RgbImage ruler_overlay(const GrayF& picture, const Ruler& ruler);

}  // namespace faba
