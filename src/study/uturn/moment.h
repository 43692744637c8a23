#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/uturn/moment_estimate.h"

namespace faba {

/// A video of cells in a field of one strength that is reversed.
struct MomentVideo {
  std::filesystem::path file;
  double field_t = 0;
  std::vector<double> reversals_s;  ///< ascending
  double fps = 0;                   ///< 0: of the video
};

struct MomentJob {
  std::vector<MomentVideo> videos;
  std::optional<CellBody> cell;  ///< empty: only the turning rate is estimated
  double field_sd = 0;           ///< relative standard deviation of the calibration of all fields
  unsigned threads = 0;
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress =
      [](auto&, auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Tracks the cells of each video and estimates the turning rate per field strength and the moment. Throws
/// the errors of track_video(), and Error(interrupted).
MomentEstimate measure_moment(const MomentJob& job);

/// The estimate from the surveys of the videos; `fields` has file, field_t and survey.
MomentEstimate moment_of(std::vector<FieldStrength> fields, const std::optional<CellBody>& cell,
                         double field_sd);

}  // namespace faba
