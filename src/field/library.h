#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/h5.h"
#include "field/kernels/field_table.h"

namespace faba {

/// One entry of a library: currents, the zero of the in-plane field that they make, and what it does to
/// cells.
struct LibraryEntry {
  std::vector<double> current;  ///< A, one per coil
  Vec2 zero;                    ///< m, world, z = 0
  std::array<double, 2>
      gradient{};  ///< eigenvalues of the in-plane gradient there, T/m, the smaller one first
};

/// The library of the thesis (3.3.4.2): many sets of currents, each with the zero of the field that it makes
/// and the field at the nodes of a grid, kept in a file. A controller takes the currents whose zero is
/// nearest to where it wants one.
///
/// HDF5: `current_a` (entry, coil), `zero_m` (entry, (x, y)), `gradient_t_per_m` (entry, 2), `field_t`
/// (entry, row from below, column, (x, y)); attributes `format`, `rig` (fingerprint of the rig), `low_x_m`,
/// `low_y_m`, `spacing_m`, `columns`, `rows`, `coils`, `task`.
class FieldLibrary {
 public:
  /// Throws Error(input) when the file is not a whole library.
  explicit FieldLibrary(const std::filesystem::path& file);
  FieldLibrary(const FieldLibrary&) = delete;
  FieldLibrary& operator=(const FieldLibrary&) = delete;
  ~FieldLibrary();

  /// How a library was made: the rig's fingerprint, grid and currents. Throws Error(input).
  static std::string task(const std::filesystem::path& file);

  const TableGrid& grid() const { return grid_; }
  const std::vector<LibraryEntry>& entries() const { return entries_; }
  /// The field of an entry at all nodes as in the file, T: x and y of every node, row by row from below.
  std::vector<float> field(std::size_t entry) const;
  /// The field of a rig at the nodes of the library's grid. Throws Error(input) unless this is the rig that
  /// the library was made for: the fingerprints are equal, and so is the field of some of the entries.
  FieldTable table(const Field& field, const std::string& fingerprint) const;

  /// The entry whose zero is nearest to `at` (m) among those that trap cells of `polarity` (+1 north-seeking,
  /// -1 south-seeking); of equally near ones that with the least power. Where none traps along both axes, as
  /// with two coils, among those that trap more along one than they drive away along the other.
  std::optional<std::size_t> nearest(Vec2 at, int polarity) const;

 private:
  struct Tree;
  std::filesystem::path path_;
  H5File file_;
  std::string rig_;
  TableGrid grid_;
  std::vector<LibraryEntry> entries_;
  std::unique_ptr<Tree> north_, south_;
};

/// Writes a library entry by entry. What is there stays readable whatever happens; the library gets its name
/// when it is whole.
class LibraryWriter {
 public:
  /// `task` says how the library is made, the rig included. Where an unfinished library of the same task is,
  /// its entries are taken over.
  LibraryWriter(const std::filesystem::path& file, const std::string& rig, const std::string& task,
                const TableGrid& grid, std::size_t coils);
  /// Sets of currents that need not be tried again: where to go on.
  std::uint64_t done() const { return done_; }
  std::size_t entries() const;
  /// `combination` counts what was tried, upwards.
  void add(std::uint64_t combination, const LibraryEntry& e, std::span<const float> field);
  /// All sets of currents before this one were tried: an unfinished library goes on from here.
  void tried(std::uint64_t combinations);
  void finish();

 private:
  void take_over(const std::string& task);

  std::filesystem::path path_, part_;
  H5File file_;
  std::optional<H5Table> combination_, current_, zero_, gradient_, field_, tried_, whole_;
  std::uint64_t done_ = 0;
};

}  // namespace faba
