#pragma once
#include <filesystem>
#include <vector>

namespace faba {

/// A reversal of the field that a run recorded.
struct FieldReversal {
  double t_s = 0;            ///< time of the run
  double direction_deg = 0;  ///< swimming direction of its cells afterwards, image frame: 0 right, 90 down
};

/// The times at which the recorded field of a run turned by more than 90 degrees, the field being zero in
/// between or not. Empty when `run` is not a run directory or has no record of the field.
std::vector<FieldReversal> recorded_reversals(const std::filesystem::path& run);

}  // namespace faba
