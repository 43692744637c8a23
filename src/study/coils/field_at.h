#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"
#include "field/null.h"

namespace faba {

/// The field of a coil system at points, with its default currents.
struct FieldAtPoints {
  std::vector<double> current;  ///< A, one per coil
  std::vector<Vec3> at, b;      ///< m and T, world frame
};
/// `points` is a CSV with the columns x_m, y_m and z_m. Throws Error(usage) for an invalid coil system,
/// Error(input) for invalid points.
FieldAtPoints field_at_points(const std::filesystem::path& rig, const std::filesystem::path& points);

/// null_at() with the current limits of the coils. Throws Error(usage) with the file name `rig` when the
/// field is unknown at `at` (in a winding or outside a measured map), or the coils cannot produce a zero
/// there.
FieldNull checked_null_at(const Field& field, const std::filesystem::path& rig, Vec2 at, int polarity);

/// Name of the first coil that has a position in its bore, winding or core; empty if none does.
std::string coil_around(const Field& field, Vec2 at);

/// A note on a zero at a position inside a coil, or with a gradient too weak for cells; empty for others.
std::string position_note(const Field& field, const FieldNull& n, Vec2 at);

/// Currents for a zero of the field at a point in the plane of the sample.
struct RigNull {
  Vec2 at;                         ///< m
  std::vector<std::string> coils;  ///< their names
  FieldNull null;
  std::string note;  ///< reason when the zero does not trap cells or is in a coil; else empty
};
/// The zero at `at` (m) that traps cells of `polarity` (+1 or -1). Throws Error(usage).
RigNull null_of_rig(const std::filesystem::path& rig, Vec2 at, int polarity);

}  // namespace faba
