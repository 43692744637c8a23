#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/h5/h5.h"
#include "field/library.h"

namespace faba {

// A field library in a file. HDF5: `current_a` (entry, coil), `zero_m` (entry, (x, y)), `gradient_t_per_m`
// (entry, 2), `field_t` (entry, row from below, column, (x, y)); attributes `format`, `rig` (hash of
// the coils), `low_x_m`, `low_y_m`, `spacing_m`, `columns`, `rows`, `coils`, `task`.

/// The library in a file, which stays open. Throws Error(input) when the file is not a complete library.
std::shared_ptr<const FieldLibrary> open_library(const std::filesystem::path& file);

/// How the library in a file was made: hash of the coils, grid and currents. Throws Error(input).
std::string library_task(const std::filesystem::path& file);

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
