#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "field/null.h"

namespace faba {

/// What `faba field map` shows: the field of a rig in the plane of the sample over a rectangle about its
/// centre.
struct FieldMapOptions {
  double width = 6e-3, height = 4.5e-3;  ///< m
  std::vector<double> current = {};      ///< A, one per coil; the coils' own when empty
  std::optional<Vec2> view = {};         ///< width and height of the camera's view, m, drawn about the centre
  double drop_radius = 0;                ///< m, drawn about the centre; 0: none
  std::filesystem::path picture, hdf5;   ///< written unless empty
};

struct FieldMap {
  /// A zero of the field in the plane.
  struct Zero {
    Vec2 at;                ///< m
    NullGradient gradient;  ///< T/m, eigenvalues in the plane
    std::string kind;       ///< whom it traps
  };
  /// The table that a swarm would swim in over this rectangle.
  struct Table {
    double spacing;  ///< m
    int columns, rows;
    double error;  ///< largest difference from the field, as a fraction of each coil's largest field
  };
  std::vector<double> current;  ///< A, one per coil
  std::string note;             ///< empty when all is well
  std::vector<Zero> zeros;
  double strongest = 0;        ///< T, in the plane
  std::optional<Table> table;  ///< none when a coil reaches into the rectangle and a picture or file is made
};
/// Draws the map and writes it as HDF5 (`b_t`, rows by columns by (x, y, z), from the top; `x_m`, `y_m`).
/// Throws Error(usage) when a coil reaches into the rectangle.
FieldMap field_map(const std::filesystem::path& rig, const FieldMapOptions& options);

}  // namespace faba
