#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace faba {

/// How far a zero of the field moves when one thing is not as assumed.
struct FieldTolerance {
  struct Row {
    std::string cause, words;
    double amount;
    std::string unit;             ///< of `amount`
    std::optional<double> shift;  ///< m, the largest of all coils and directions; none when the zero is lost
  };
  Vec2 at;                      ///< m
  std::vector<double> current;  ///< A, one per coil, that make the zero
  bool saddle = false;
  std::vector<Row> rows;
};

/// Tries the current of a coil, its place along and across its axis, its direction, and the Earth's field,
/// each for every coil and direction. Unless `picture` is empty the table is drawn there as SVG. Throws
/// Error(usage) when the rig has no zero at `at`.
FieldTolerance field_tolerance(const std::filesystem::path& rig, Vec2 at,
                               const std::filesystem::path& picture);

}  // namespace faba
