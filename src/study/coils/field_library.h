#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace faba {

/// Options of `faba field library`.
struct FieldLibraryOptions {
  double width = 2e-3, height = 2e-3;  ///< of the rectangle about the centre that contains the zeros, m
  double spacing = 0;                  ///< of the grid, m; 0: 1/64 of the longer side
  int levels = 0;                      ///< steps from zero to the largest current; 0: by the number of coils
  unsigned threads = 0;                ///< 0: all
  bool force = false;                  ///< replace an existing library
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Summary of a new library, and its comparison with the solver null_at().
struct FieldLibrarySummary {
  std::filesystem::path out;
  std::uint64_t combinations = 0;  ///< sets of currents of the lattice
  std::size_t entries = 0;         ///< sets of currents with a zero
  std::int64_t traps = 0;          ///< entries that are not saddles
  int levels = 0, columns = 0, rows = 0;
  /// Distance from points on a grid over the rectangle to the nearest zero, m; empty without entries.
  struct Distance {
    double median, largest;
  };
  std::optional<Distance> off;
  std::optional<double> strength;  ///< median trapping gradient, as a fraction of that of the solver
};

/// Builds a FieldLibrary. It tests all sets of currents on a lattice of `levels` steps to either side with at
/// least one coil at its limit (smaller currents in the same ratio make nearly the same zero and a weaker
/// trap), and keeps those whose zero in the rectangle traps at least half as strongly as the best one at the
/// centre. An unfinished library of the same task is resumed. Throws Error(interrupted) when stopped.
FieldLibrarySummary build_field_library(const std::filesystem::path& rig, const std::filesystem::path& out,
                                        const FieldLibraryOptions& options);

}  // namespace faba
