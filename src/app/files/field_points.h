#pragma once
#include <filesystem>

#include "app/files/field_table.h"
#include "core/table.h"

namespace faba {

/// Table of a measured or computed field, for field_data(), from text (read_field_table()) or HDF5 (file
/// extension .h5 or .hdf5). HDF5 has the format of `faba field map`: `b_t` (y, x, component) on the grid
/// `x_m` by `y_m` in the plane z = 0; or `b_t` (point, component) with `x_m`, `y_m`, `z_m` (point). Throws
/// Error(input) with the file and the reason, and Error(usage) for a `format` of an HDF5 file.
Table read_field_points(const std::filesystem::path& file, const FieldTableFormat& format = {});

}  // namespace faba
