#pragma once
#include "core/frame.h"
#include "core/schema.h"
#include "core/signals.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// Scenario parameters of estimators that process camera frames.
struct ForegroundParams {
  enum class Cells { automatic, dark, bright };
  double cell_px = 3;
  Cells cells = Cells::automatic;
  double threshold_sd = 5;
  double absorb = 150;  ///< s
  bool learn = true;

  ForegroundOptions options() const;
};

/// Schema of a part with these parameters.
Schema<ForegroundParams> foreground_schema(const char* name, const char* summary);

/// The camera frame of an observation. Throws Error(Errc::usage, "estimator") when it is absent or its size
/// differs from that of the view.
const Image<std::uint8_t>& camera_picture(const Observation& o, const Frame& frame);

}  // namespace faba
