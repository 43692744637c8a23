#pragma once
#include <string>

#include "app/scenario/parts.h"

namespace faba {

/// The table [library]: a FieldLibrary that provides the grid of the run, and the currents of gradient
/// controllers.
struct LibraryParams {
  std::string file;
  std::string made;  ///< hash of the task of the library
  static Schema<LibraryParams> schema();
  /// Parameters for the scenario hash: all except the path of the file.
  Json hashed() const;
};

/// Reads [library]: finds the file and sets `made`. Throws Error(usage), and Error(input) if it is not the
/// library with which the scenario was created.
LibraryParams read_library(const Node& root, const Readers& readers);

}  // namespace faba
