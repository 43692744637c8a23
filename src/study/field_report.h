#pragma once
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/vec.h"

namespace faba {

/// The field of a rig at points, with its coils' own currents.
struct FieldAtPoints {
  std::vector<double> current;  ///< A, one per coil
  std::vector<Vec3> at, b;      ///< m and T, world frame
};
/// `points` is a CSV with the columns x_m, y_m and z_m. Throws Error(usage) for the rig, Error(input) for the
/// points.
FieldAtPoints field_at_points(const std::filesystem::path& rig, const std::filesystem::path& points);

/// Currents for a zero of the field at `at` (m, in the plane of the sample) that traps cells of `polarity`,
/// as the command line and the web page report it:
/// `{"at_m":[x,y],"coils":[..],"currents_a":[..],"eigenvalues_t_per_m":[a,b],"dbz_dz_t_per_m":c,"reachable":..,
/// "saddle":..,"note":".."}`, the note empty when all is well. Throws Error(usage).
nlohmann::ordered_json null_report(const std::filesystem::path& rig, Vec2 at, int polarity);

}  // namespace faba
