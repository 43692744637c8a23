#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"
#include "field/null.h"

namespace faba {

/// The field of a rig at points, with its coils' own currents.
struct FieldAtPoints {
  std::vector<double> current;  ///< A, one per coil
  std::vector<Vec3> at, b;      ///< m and T, world frame
};
/// `points` is a CSV with the columns x_m, y_m and z_m. Throws Error(usage) for the rig, Error(input) for the
/// points.
FieldAtPoints field_at_points(const std::filesystem::path& rig, const std::filesystem::path& points);

/// null_at() with the coils' own limits. Throws Error(usage) naming `rig` where its field is not known: in a
/// winding or outside of a measured map.
FieldNull null_where_known(const Field& field, const std::filesystem::path& rig, Vec2 at, int polarity);

/// Currents for a zero of the field at a place in the plane of the sample.
struct RigNull {
  Vec2 at;                         ///< m
  std::vector<std::string> coils;  ///< their names
  FieldNull null;
  std::string note;  ///< why it traps nothing; empty when all is well
};
/// The zero at `at` (m) that traps cells of `polarity` (+1 or -1). Throws Error(usage).
RigNull null_of_rig(const std::filesystem::path& rig, Vec2 at, int polarity);

}  // namespace faba
