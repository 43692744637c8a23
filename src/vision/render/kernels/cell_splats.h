#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/frame.h"
#include "core/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// One cell as the camera meets it. Image frame: x right, y down, px, pixel centres at whole numbers.
struct CameraCell {
  float x = 0, y = 0;    ///< at mid-exposure
  float ux = 0, uy = 0;  ///< unit vector along a rod's axis; (0, 0): drawn round
  float dx = 0, dy = 0;  ///< way during the exposure, px
};

/// Size and optics of a cell in px.
struct SplatShape {
  double psf_sd_px = 0.5;
  double diameter_px = 1.5, length_px = 1.5;
  double depth_spread = 0;  ///< sd of the distances from focus, in depths of field; 0: all in focus
  double weight = 1;        ///< what a cell adds to the picture in all: sum over its pixels
  std::uint64_t seed = 1;   ///< of the depths
};

/// Adds blurred cells to a picture, each with its whole weight wherever between pixels it lies. A cell is a
/// row of equal Gaussian spots along its axis and its way; a spot has the variance of the point-spread
/// function plus that of a disc (diameter^2/16 along each axis), cut off at 4 sd and integrated over each
/// pixel. Spots are products of a row and a column, read from tables with 64 places between two pixels and
/// interpolated between those. Same cells, same bits, for any number of threads: a pixel's sum runs in the
/// order of the cells (theory G2).
class CellSplats {
 public:
  explicit CellSplats(const SplatShape& shape);
  ~CellSplats();
  CellSplats(CellSplats&&) noexcept;
  CellSplats& operator=(CellSplats&&) noexcept;

  /// Adds `cells` to `sum`. What lies outside of the picture is left out.
  void add(std::span<const CameraCell> cells, GrayF& sum, Pool& pool);

 private:
  struct Spot;
  class Table;
  void lay_out(std::span<const CameraCell> cells, const GrayF& sum);
  void put(const CameraCell& cell, const Table& table, std::uint16_t sharpness, const GrayF& sum);
  void sort_into_bands(int height);

  SplatShape shape_;
  std::vector<Table> tables_;        ///< by sharpness: from in focus to four times as wide
  std::vector<std::uint8_t> depth_;  ///< sharpness of each cell, drawn when it is first seen
  std::vector<Spot> spots_;
  std::vector<std::uint32_t> in_band_, band_begin_;
};

}  // namespace faba
