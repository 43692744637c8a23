#pragma once
#include <string>

#include "app/scenario/parts.h"

namespace faba {

/// The table [library]: a FieldLibrary that the run takes its grid from, and controllers of gradients their
/// currents.
struct LibraryParams {
  std::string file;
  std::string made;  ///< hash of how the library was made
  static Schema<LibraryParams> schema();
  /// What tells it from another one: how it was made, wherever it lies.
  Json hashed() const;
};

/// Reads [library]: finds the file and fills in `made`. Throws Error(usage), and Error(input) when it is
/// another library than the scenario was made with.
LibraryParams read_library(const Node& root, const Readers& readers);

}  // namespace faba
