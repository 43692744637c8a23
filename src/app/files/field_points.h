#pragma once
#include <filesystem>

#include "core/table.h"

namespace faba {

/// The table of a measured or computed field, for field_data(): CSV, or HDF5 told by its name (.h5, .hdf5) as
/// `faba field map` writes it: `b_t` with rows of (x, y, z) along `x_m`, one row for each of `y_m`, in the
/// plane z = 0; or `b_t` with one (x, y, z) a row and `x_m`, `y_m`, `z_m` as long. Throws Error(input) naming
/// the file and what is expected.
Table read_field_points(const std::filesystem::path& file);

}  // namespace faba
