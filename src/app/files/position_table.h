#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/h5/h5.h"
#include "core/vec.h"

namespace faba {

/// The positions of all cells in tracks.h5: a row of x and y of every cell in the picture, px, for each
/// recorded frame. Either exact, as float in the table `position_px`; or rounded to a resolution, in
/// `position_steps`: 16-bit integers, in the first row of every chunk the position in units of the
/// resolution, in the others the difference from the row before, modulo 2^16, which compresses well
/// (docs/formats/run-directory.md).
class PositionTable {
 public:
  /// How positions are rounded.
  struct Rounding {
    double resolution_px = 0;
    Vec2 origin_px;  ///< position of the value 0
  };

  /// A new table for `cells` cells with chunks of `chunk_rows` rows. No rounding: exact positions.
  PositionTable(H5File& file, std::uint64_t cells, std::uint64_t chunk_rows, bool compress,
                const std::optional<Rounding>& rounding);
  /// The table of an existing file. Throws Error(input).
  explicit PositionTable(const H5File& file);

  /// Name of the table in the file.
  const char* name() const;
  std::uint64_t rows() const { return table_->rows(); }
  std::uint64_t cells() const { return table_->row_size() / 2; }
  /// x, y of the first cell, x, y of the second, and so on. Throws Error(internal) if a rounded position does
  /// not fit into 16 bits.
  void append(std::span<const float> xy_px);
  /// Rows that are read in order need no others.
  void read(std::uint64_t row, std::span<float> xy_px);

  /// The smallest resolution for positions up to `reach_px` from the origin in x and in y.
  static double finest_px(double reach_px);

 private:
  void read_steps(std::uint64_t row);

  std::optional<H5Table> table_;
  std::optional<Rounding> rounding_;
  std::uint64_t chunk_rows_ = 1;
  std::vector<std::uint16_t> last_;  ///< the newest row that was written or read, in units of the resolution
  std::vector<std::int16_t> steps_;
  std::uint64_t last_row_ = 0;
  bool has_last_ = false;
};

}  // namespace faba
