#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "study/quality/quality.h"
#include "study/uturn/u_turns.h"

namespace faba {

/// The body of the cells, for the rotational drag.
struct CellBody {
  double length = 0, width = 0;  ///< m; a coccus has equal ones
  double viscosity = 0.89e-3;    ///< Pa s
  double drag_factor = 1;        ///< drag with flagella over that of the body
  double drag_sd = 0;  ///< relative standard deviation of the drag, because of size, shape and flagella
};

/// A median over cells and the 90 % interval of this median.
struct MedianInterval {
  double median = 0;
  std::array<double, 2> ci90{};
};

/// The turns of one video.
struct FieldStrength {
  std::filesystem::path file;
  double field_t = 0;
  UTurnSurvey survey;
  double bias = 1;                                ///< of the estimated rate, from simulated turns; corrected
  std::optional<MedianInterval> rate_per_t = {};  ///< 1 / (s T)
};

/// Magnetic moment from the turns of all videos.
struct MomentEstimate {
  std::vector<FieldStrength> fields;
  std::optional<MedianInterval> rate_per_t;  ///< turning rate per field, m / f_r; empty without turns
  std::optional<double> drag;                ///< f_r, N m s
  std::optional<MedianInterval> moment;      ///< A m^2; empty without turns or body
  std::uint64_t turns = 0;
  std::vector<Warning> warnings;
};

}  // namespace faba
