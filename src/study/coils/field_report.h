#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
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

/// What `faba field map` shows: the field of a rig in the plane of the sample over a rectangle about its
/// centre.
struct FieldMapOptions {
  double width = 6e-3, height = 4.5e-3;  ///< m
  std::vector<double> current = {};      ///< A, one per coil; the coils' own when empty
  std::optional<Vec2> view = {};         ///< width and height of the camera's view, m, drawn about the centre
  double drop_radius = 0;                ///< m, drawn about the centre; 0: none
  std::filesystem::path picture, hdf5;   ///< written unless empty
};
/// Draws the map and writes it as HDF5 (`b_t`, rows by columns by (x, y, z), from the top; `x_m`, `y_m`), and
/// says
/// `{"currents_a":[..],"note":"..","zeros":[{"at_m":[x,y],"eigenvalues_t_per_m":[a,b],"kind":".."}],"strongest_t":..,
/// "table":{"spacing_m":..,"columns":..,"rows":..,"error":..}}`: the table is what a swarm would swim in over
/// this rectangle, and its error the largest difference from the field, as a share of each coil's largest
/// field. Throws Error(usage) when a coil reaches into the rectangle.
nlohmann::ordered_json field_map(const std::filesystem::path& rig, const FieldMapOptions& options);

/// What `faba field library` makes.
struct FieldLibraryOptions {
  double width = 2e-3, height = 2e-3;  ///< m, of the rectangle about the centre that zeros are wanted in
  double spacing = 0;                  ///< m, of the grid; 0: a 64th of the longer side
  int levels = 0;                      ///< steps from no current to the largest; 0: by the number of coils
  unsigned threads = 0;                ///< 0: all
  bool force = false;                  ///< replace an existing library
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};
/// Builds a FieldLibrary: of all sets of currents on a lattice of `levels` steps to either side, with at
/// least one coil at its limit (weaker currents in the same ratio make nearly the same zero, and trap less),
/// those that make a zero in the rectangle which traps at least half as strongly as the best one at its
/// centre. An unfinished library of the same task goes on where it was. Says
/// `{"out":..,"combinations":n,"entries":m,"traps":k,"levels":..,"columns":..,"rows":..,"off_m":{"median":..,"largest":..},
/// "strength":..}`: how far the nearest zero of the library is from places all over the rectangle, and what
/// share of the trap's gradient that the solver (null_at) reaches there it has in the median; `traps` are the
/// entries that are no saddles. Throws Error(interrupted) when stopped.
nlohmann::ordered_json build_field_library(const std::filesystem::path& rig, const std::filesystem::path& out,
                                           const FieldLibraryOptions& options);

/// How far the zero of the field that null_report() gives at `at` moves when one thing is not as assumed: the
/// current of a coil, its place along and across its axis, its direction, the Earth's field. Each is tried
/// for every coil and direction, and the largest shift counts:
/// `{"at_m":[x,y],"currents_a":[..],"rows":[{"cause":"current","words":"..","amount":10,"unit":"%","shift_m":..,"lost":false},..]}`,
/// `lost` when the zero is nowhere near any more, and shift_m then null. Unless `picture` is empty the table
/// is drawn there as SVG. Throws Error(usage) when the rig has no zero there.
nlohmann::ordered_json field_tolerance(const std::filesystem::path& rig, Vec2 at,
                                       const std::filesystem::path& picture);

/// Brings a rig, with its coils' own currents, to a measured field (FieldData) by least squares: one factor
/// on all coils, one shift of all coils (along z only for data about an axis), and one added field. Standard
/// errors take the errors of measurement as equal and independent.
/// `{"values":n,"gain":..,"gain_se":..,"shift_m":[x,y,z],"shift_se_m":[..],"offset_t":[..],"offset_se_t":[..],
/// "rms_t":..,"rms_field_t":..,"note":".."}`, a standard error null where nothing was fitted. Unless empty,
/// `out` is written as the rig that fits, `picture` as SVG with what is left over. Throws Error(usage) for a
/// rig without current, Error(input) for data that are wrong, too few, or do not tell.
nlohmann::ordered_json field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                                 const std::filesystem::path& out, const std::filesystem::path& picture);

/// Currents for a zero of the field at `at` (m, in the plane of the sample) that traps cells of `polarity`,
/// as the command line and the web page report it:
/// `{"at_m":[x,y],"coils":[..],"currents_a":[..],"eigenvalues_t_per_m":[a,b],"dbz_dz_t_per_m":c,"reachable":..,
/// "saddle":..,"note":".."}`, the note empty when all is well. Throws Error(usage).
nlohmann::ordered_json null_report(const std::filesystem::path& rig, Vec2 at, int polarity);

}  // namespace faba
