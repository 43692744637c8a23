#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/frame.h"
#include "core/threads/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// One cell in a camera frame. Image frame: x right, y down, px, pixel centres at integer positions.
struct CameraCell {
  float x = 0, y = 0;    ///< position at mid-exposure
  float ux = 0, uy = 0;  ///< unit vector along the axis of a rod; (0, 0): drawn round
  float dx = 0, dy = 0;  ///< displacement during the exposure, px
};

/// Size and optics of a cell in px.
struct SplatShape {
  double psf_sd_px = 0.5;
  double diameter_px = 1.5, length_px = 1.5;
  double depth_spread =
      0;  ///< sd of the distances from focus, in units of the depth of field; 0: all cells in focus
  double weight = 1;       ///< sum of the pixel values that a cell adds
  std::uint64_t seed = 1;  ///< seed of the depths
};

/// Adds blurred cells to a picture; the sum of each cell does not depend on its sub-pixel position. A cell is
/// a row of equal Gaussian spots along its axis and its displacement. The variance of a spot is that of the
/// point-spread function plus that of a disc (diameter^2/16 along each axis); it is cut off at 4 sd and
/// integrated over each pixel. Spots are products of a row and a column profile from tables with 64 sub-pixel
/// positions, interpolated linearly. Bit-identical for any number of threads: the contributions to a pixel
/// are summed in the order of the cells (theory G2).
class CellSplats {
 public:
  explicit CellSplats(const SplatShape& shape);
  ~CellSplats();
  CellSplats(CellSplats&&) noexcept;
  CellSplats& operator=(CellSplats&&) noexcept;

  /// Adds `cells` to `sum`. Parts outside the picture are clipped.
  void add(std::span<const CameraCell> cells, GrayF& sum, Pool& pool);

 private:
  struct Spot;
  class Table;
  void make_spots(std::span<const CameraCell> cells, const GrayF& sum);
  void add_spots(const CameraCell& cell, const Table& table, std::uint16_t blur_level, const GrayF& sum);
  void sort_into_bands(int height);

  SplatShape shape_;
  std::vector<Table> tables_;        ///< by blur level: from in focus to four times as wide
  std::vector<std::uint8_t> depth_;  ///< blur level of each cell, drawn at its first frame
  std::vector<Spot> spots_;
  std::vector<std::uint32_t> in_band_, band_begin_;
};

}  // namespace faba
