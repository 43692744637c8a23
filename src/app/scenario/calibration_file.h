#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "core/schema.h"

namespace faba {

/// The scale of a camera as `faba scale --out` writes it, the table [scale] of a file of its own.
struct Calibration {
  double um_per_px = 0;
  std::optional<Vec2> ci95;  ///< ends of its 95 % interval, um/px
  std::string method;        ///< how it was found, in words
  std::string source;        ///< the file that it was found from
  static Schema<Calibration> schema();
};

/// Reads the table [scale] of a calibration file; a scenario with um_per_px in it will do. Throws
/// Error(usage) naming file, line and reason.
Calibration read_calibration(const std::filesystem::path& file);

/// Writes a calibration file, as a whole. Throws Error(Errc::internal, file).
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

/// The value of an option such as `--scale FILE_OR_NUMBER`: a number in um/px ("0.9164"), a number with its
/// unit
/// ("0.9164 um/px"), or a calibration file. `where` is the option's name. Throws Error(usage).
Calibration parse_calibration(const std::string& words, const std::string& where);

/// Puts um_per_px of the calibration file named by the scenario's `scale.file`, relative to the scenario or
/// to where the program was called, in the key's place, so that what is recorded stands by itself. Throws
/// Error(usage) when the scenario gives um_per_px as well.
void include_calibration(Document& scenario);

}  // namespace faba
