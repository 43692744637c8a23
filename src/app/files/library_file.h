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

/// The library in a file, which stays open. Throws Error(input) if the file is not a complete library.
std::shared_ptr<const FieldLibrary> open_library(const std::filesystem::path& file);

/// Task of the library in a file: text with the hash of the coils, grid and currents. Throws Error(input).
std::string library_task(const std::filesystem::path& file);

/// Writes a library entry by entry. Written entries stay readable after a crash; the file is renamed to its
/// final name when the library is complete.
class LibraryWriter {
 public:
  /// `task` identifies the coils, grid and currents. Imports the entries of an unfinished library of the same
  /// task.
  LibraryWriter(const std::filesystem::path& file, const std::string& rig, const std::string& task,
                const TableGrid& grid, std::size_t coils);
  /// Number of sets of currents already tried: where to resume.
  std::uint64_t done() const { return done_; }
  std::size_t entries() const;
  /// `combination`: number of the set of currents, increasing.
  void add(std::uint64_t combination, const LibraryEntry& e, std::span<const float> field);
  /// Records that all sets of currents before this one were tried: an unfinished library is resumed from
  /// here.
  void tried(std::uint64_t combinations);
  void finish();

 private:
  void import_unfinished(const std::string& task);

  std::filesystem::path path_, part_;
  H5File file_;
  std::optional<H5Table> combination_, current_, zero_, gradient_, field_, tried_, entries_;
  std::uint64_t done_ = 0;
};

}  // namespace faba
