#include "study/quality/scale_warning.h"

#include <fmt/format.h>

namespace faba {

std::vector<Warning> scale_warnings(const std::optional<double>& nominal_um_per_px) {
  if (!nominal_um_per_px) return {};
  return {
      {"scale",
       "the scale of the picture is not known: lengths are stated in px only, and the simulated cells are "
       "as large and as fast as at a nominal scale",
       fmt::format("nominal scale {:g} um per px", *nominal_um_per_px),
       "give scale.um_per_px, or scale.file, a calibration file of `faba scale`"}};
}

}  // namespace faba
