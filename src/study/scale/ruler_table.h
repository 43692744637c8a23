#pragma once
#include <filesystem>
#include <vector>

namespace faba {

/// Readings of the lines or distances of a ruler: the true width and the measured width in pixels of each.
struct RulerReadings {
  std::vector<double> width_m;
  std::vector<double> reading_px;
};

/// Reads a table of readings: one column of widths, whose name ends with a unit of
/// length (`width_um`, `width (mm)`, `um`), and one or more columns of readings in pixels. When some names
/// contain `px` or `pixel`, those columns are the readings, else all other columns. One row per width with
/// its readings in several columns, or one row per reading. Throws Error(input) with file and line for a
/// value that is not a positive number, a missing unit and a table without readings.
RulerReadings read_ruler_table(const std::filesystem::path& file);

/// Whether a file is a table of readings: its name ends in .csv, .tsv, .txt or .dat.
bool is_ruler_table(const std::filesystem::path& file);

}  // namespace faba
