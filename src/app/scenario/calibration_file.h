#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "core/schema.h"

namespace faba {

/// The scale of a camera: table [scale] of a calibration file, written by `faba scale --out`.
struct Calibration {
  double um_per_px = 0;
  std::optional<Vec2> ci95;                         ///< limits of its 95 % interval, um/px
  std::string method;                               ///< method of measurement
  std::string source;                               ///< file with the measurement
  bool typed() const { return method == "given"; }  ///< a number, not a calibration file
  static Schema<Calibration> schema();
};

/// Reads the table [scale] of a calibration file, or of a scenario with um_per_px. Throws Error(usage) with
/// file, line and reason.
Calibration read_calibration(const std::filesystem::path& file);

/// Writes a calibration file atomically. Throws Error(Errc::internal, file).
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

/// Value of an option such as `--um-per-px FILE_OR_NUMBER`: a number in um/px ("0.9164", "0.9164 um/px"), or
/// a calibration file. `where` is the name of the option. Throws Error(usage).
Calibration parse_calibration(const std::string& text, const std::string& where);

/// Replaces the key `scale.file` of a scenario by um_per_px of that calibration file (path relative to the
/// scenario or to the working directory), so that the recorded scenario is self-contained. Throws
/// Error(usage) if the scenario also gives um_per_px.
void include_calibration(Document& scenario);

}  // namespace faba
