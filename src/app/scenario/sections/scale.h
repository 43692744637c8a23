#pragma once
#include <optional>

#include "core/schema.h"

namespace faba {

/// The table [scale].
struct ScaleParams {
  double um_per_px = 0.9164;
  std::optional<double> iteration;
  double field_unit = 23e-6;
  static Schema<ScaleParams> schema();
};

/// JSON Schema of the key scale.file, which include_calibration() replaces by um_per_px.
Json calibration_file_json_schema();

}  // namespace faba
