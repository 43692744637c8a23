#pragma once
#include <filesystem>
#include <vector>

namespace faba {

/// Readings of a ruler's lines or distances: one width and the pixels it was read as, for each reading.
struct RulerReadings {
  std::vector<double> width_m;
  std::vector<double> reading_px;
};

/// Reads a table of readings: one column of widths, whose name says `width` or `um` and ends with a unit of
/// length (`width_um`, `width (mm)`, `um`), and one or more of readings in pixels. When the names of some
/// columns say `px` or `pixel` those are the readings, else all others are. One row for each width with its
/// readings side by side, or one row for each reading. Throws Error(input) naming file and line for anything
/// that is not a positive number, for a missing unit and for no readings.
RulerReadings read_ruler_table(const std::filesystem::path& file);

/// Whether a file is taken for a table of readings: its name ends in .csv, .tsv, .txt or .dat.
bool is_ruler_table(const std::filesystem::path& file);

}  // namespace faba
