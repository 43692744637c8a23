#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace faba {

/// Shift of a zero of the field when one property of the coil system deviates from its file.
struct FieldTolerance {
  struct Row {
    std::string cause, words;
    double amount;
    std::string unit;             ///< of `amount`
    std::optional<double> shift;  ///< m, largest over all coils and directions; empty when the zero is lost
  };
  Vec2 at;                      ///< m
  std::vector<double> current;  ///< currents that make the zero, A, one per coil
  bool saddle = false;
  std::vector<Row> rows;
  std::string note;  ///< position_note()
};

/// Changes the current of a coil, its position along and across its axis, its direction, and the ambient
/// field, for every coil and direction. Unless `picture` is empty the result is drawn there as SVG. Throws
/// Error(usage) when the coil system cannot produce a zero at `at`.
FieldTolerance field_tolerance(const std::filesystem::path& rig, Vec2 at,
                               const std::filesystem::path& picture);

}  // namespace faba
