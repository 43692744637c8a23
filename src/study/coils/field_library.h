#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace faba {

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

/// A library that was built, and how it compares with the solver null_at().
struct FieldLibrarySummary {
  std::filesystem::path out;
  std::uint64_t combinations = 0;  ///< sets of currents that were tried
  std::size_t entries = 0;         ///< those that make a zero
  std::int64_t traps = 0;          ///< entries that are no saddles
  int levels = 0, columns = 0, rows = 0;
  /// How far the nearest zero of the library is from places all over the rectangle, m; none without entries.
  struct Distance {
    double median, largest;
  };
  std::optional<Distance> off;
  std::optional<double> strength;  ///< median fraction of the gradient that the solver's trap has there
};

/// Builds a FieldLibrary: of all sets of currents on a lattice of `levels` steps to either side, with at
/// least one coil at its limit (weaker currents in the same ratio make nearly the same zero, and trap less),
/// those that make a zero in the rectangle which traps at least half as strongly as the best one at its
/// centre. An unfinished library of the same task is resumed. Throws Error(interrupted) when stopped.
FieldLibrarySummary build_field_library(const std::filesystem::path& rig, const std::filesystem::path& out,
                                        const FieldLibraryOptions& options);

}  // namespace faba
