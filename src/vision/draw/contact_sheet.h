#pragma once
#include <string>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"
#include "vision/image/region.h"

namespace faba {

/// A frame of a contact sheet with marked positions (px of the frame, y down).
struct SheetFrame {
  GrayF picture;
  std::vector<Vec2> marks;
  std::string caption;  ///< ASCII
};

/// How the frames of a contact sheet are drawn.
struct SheetStyle {
  std::string title;             ///< ASCII
  float black = 0, white = 255;  ///< contrast range of the frames
  double ring_px = 8;            ///< radius of the ring around a mark, px of the frame
  PixelRegion region;            ///< drawn as a rectangle
  int columns = 3;
};

/// Frames of the same size side by side, each at most about 640 px wide, with a ring around every mark and a
/// caption below. Small frames are enlarged. An empty picture when there are no frames.
RgbImage contact_sheet(const std::vector<SheetFrame>& frames, const SheetStyle& style);

}  // namespace faba
