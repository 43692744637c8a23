#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "field/null.h"

namespace faba {

/// Options of `faba field map`: the field of a coil system in the plane of the sample, over a rectangle about
/// its centre.
struct FieldMapOptions {
  double width = 6e-3, height = 4.5e-3;  ///< m
  std::vector<double> current = {};      ///< A, one per coil; the default currents when empty
  std::optional<Vec2> view = {};         ///< width and height of the camera view, m, drawn about the centre
  double drop_radius = 0;                ///< m, drawn about the centre; 0: none
  std::filesystem::path picture, hdf5;   ///< written unless empty
};

struct FieldMap {
  /// A zero of the field in the plane.
  struct Zero {
    Vec2 at;                ///< m
    NullGradient gradient;  ///< T/m, eigenvalues in the plane
    std::string kind;       ///< "traps north-seekers", "traps south-seekers" or "saddle"
  };
  /// Properties of the table that a simulation would use for this rectangle.
  struct Table {
    double spacing;  ///< m
    int columns, rows;
    double error;  ///< largest difference from the field, as a fraction of each coil's largest field
  };
  std::vector<double> current;  ///< A, one per coil
  std::string note;             ///< warnings; empty if there are none
  std::vector<Zero> zeros;
  double strongest = 0;        ///< T, in the plane
  std::optional<Table> table;  ///< empty when a coil is inside the rectangle and a picture or file is written
};
/// The zeros of the in-plane field in a rectangle about the centre, searched from a grid of `starts` x
/// `starts` points; zeros within 0.1 % of its width are equal. None if all currents are zero.
std::vector<FieldMap::Zero> field_zeros(const Field& field, const std::vector<double>& current, double width,
                                        double height, int starts = 21);
/// Computes the map; draws it and writes it as HDF5 (`b_t`, rows by columns by (x, y, z), from the top;
/// `x_m`, `y_m`) when requested. Throws Error(usage) when a coil is inside the rectangle and nothing is
/// written, and when the field is unknown in all of the rectangle.
FieldMap field_map(const std::filesystem::path& rig, const FieldMapOptions& options);

}  // namespace faba
