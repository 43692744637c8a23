#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/signals.h"

namespace faba {

/// A rectangle in the image, px, y down.
struct PictureBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// Content of a binary message to the page; web/protocol.md has the format.
struct FrameMessage {
  std::uint32_t run = 0;
  std::uint64_t frame = 0;
  double t = 0;  ///< s
  Frame view;
  PictureBox box;                     ///< bounding box of all cells
  std::span<const float> x, y;        ///< m, world
  std::span<const std::size_t> ends;  ///< index of the first cell after each swarm
  /// Above 0: an occupancy grid with this number of sites along the longer side of the box replaces the
  /// positions, because it is smaller for large swarms.
  int sites = 0;
  std::span<const float> ux, uy;    ///< heading, world; empty for models without headings
  std::span<const float> response;  ///< 0: does not respond to the field
  std::span<const double> rows;     ///< rows of the series, `columns` values each
  std::size_t columns = 1;
  int field_columns = 0, field_rows = 0;      ///< size of `field`
  std::span<const float> field;               ///< T, x and y components at every point, image axes
  int picture_columns = 0, picture_rows = 0;  ///< size of `picture`
  std::span<const std::uint8_t> picture;      ///< grey values of the camera image; empty: none
  const Estimate* estimate = nullptr;         ///< in the message if the error of its centroid is known
  std::span<const Vec2> path;                 ///< m, world, of the plan of the controller; empty: no plan
  double path_step = 0;                       ///< s, between two positions of the path
  std::uint16_t limits = 0;                   ///< a bit for each active limit of the plan
};

/// True if 16-bit coordinates resolve the box in steps of at most 0.1 px.
bool quantised(const PictureBox& box);
std::string encode_frame(const FrameMessage& m);

}  // namespace faba
