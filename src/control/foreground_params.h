#pragma once
#include "core/frame.h"
#include "core/schema.h"
#include "core/signals.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// What estimators that look at pictures let a scenario say.
struct ForegroundParams {
  enum class Cells { automatic, dark, bright };
  double cell_px = 3;
  Cells cells = Cells::automatic;
  double threshold_sd = 5;
  double absorb = 150;  ///< s
  bool learn = true;

  ForegroundOptions options() const;
};

/// Schema of a part whose parameters are these.
Schema<ForegroundParams> foreground_schema(const char* name, const char* summary);

/// The picture of an observation. Throws Error(Errc::usage, "estimator") when there is none, and when its
/// size is not that of the frame.
const Image<std::uint8_t>& camera_picture(const Observation& o, const Frame& frame);

}  // namespace faba
