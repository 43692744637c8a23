#pragma once
#include <optional>

#include "core/schema.h"

namespace faba {

/// Scale of a picture whose scale is not known: that of the thesis's camera (A20).
inline constexpr double kNominalUmPerPx = 0.9164;

/// The table [scale].
struct ScaleParams {
  /// Origin of um_per_px: `simulated`: the default of the simulated camera; `typed`: a number given by the
  /// user; `calibration`: a file of `faba scale`; `metadata`: of a picture file.
  enum class Source { simulated, typed, calibration, metadata };

  std::optional<double> um_per_px = kNominalUmPerPx;  ///< empty: not known
  std::optional<double> nominal_um_per_px;            ///< used for the simulation when um_per_px is empty
  Source um_per_px_source = Source::simulated;
  std::optional<double> iteration;
  double field_unit = 23e-6;

  /// The scale of the simulation, known or nominal.
  double used_um_per_px() const { return um_per_px.value_or(nominal_um_per_px.value_or(kNominalUmPerPx)); }
  /// Declares the default scale as nominal: the pictures are not those of a simulated camera.
  void require_known();
  static Schema<ScaleParams> schema();
  /// Completes um_per_px_source; a nominal scale replaces the default, and a given scale replaces it.
  static void settle(ScaleParams& p, const Node& n);
};

/// "typed", "calibration", "metadata"; null for the default of a simulated camera or an unknown scale.
Json scale_source_json(const ScaleParams& p);

/// What affects a run: without the source.
Json hashed_scale(const ScaleParams& p);

/// JSON Schema of the key scale.file, which include_calibration() replaces by um_per_px.
Json calibration_file_json_schema();

}  // namespace faba
