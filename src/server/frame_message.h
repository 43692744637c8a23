#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"

namespace faba {

/// A rectangle of the picture, px, y down.
struct PictureBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// What one binary message to the page holds; web/protocol.md says how.
struct FrameMessage {
  std::uint32_t run = 0;
  std::uint64_t frame = 0;
  double t = 0;  ///< s
  Frame view;
  PictureBox box;                   ///< in which all cells are
  std::span<const float> x, y;      ///< m, world
  std::span<const float> ux, uy;    ///< heading, world; empty when cells have none
  std::span<const float> response;  ///< 0: does not feel the field
  std::span<const double> rows;     ///< of the series, `columns` each
  std::size_t columns = 1;
  int field_columns = 0, field_rows = 0;      ///< of `field`
  std::span<const float> field;               ///< T, x and y of every point, in the picture's directions
  int picture_columns = 0, picture_rows = 0;  ///< of `picture`
  std::span<const std::uint8_t> picture;      ///< grey levels as the camera saw them; empty: none
};

/// Whether coordinates of 16 bits over the box are fine enough: steps of a tenth of a pixel at most.
bool quantised(const PictureBox& box);
std::string encode_frame(const FrameMessage& m);

}  // namespace faba
