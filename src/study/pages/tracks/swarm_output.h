#pragma once
#include <filesystem>

#include "core/file.h"
#include "study/tracks/swarm_view.h"

namespace faba {

/// Writes the output of SwarmView for each frame as CSV: `frame,t_s,signal,x_px,y_px,var_xx_px2,var_xy_px2,
/// var_yy_px2`, image frame, signal in grey px^2 on a scale of 255; positions and variances are empty without
/// a visible swarm. The file has a temporary name until complete() is called, and is deleted otherwise.
class SwarmOutput {
 public:
  SwarmOutput(std::filesystem::path path, const TrackSurvey& survey, int bits);
  ~SwarmOutput();
  void write(std::uint64_t index, double t_s, const GrayF& frame);
  void complete();

 private:
  std::filesystem::path path_;
  OutputFile file_;
  SwarmView view_;
  bool complete_ = false;
};

}  // namespace faba
