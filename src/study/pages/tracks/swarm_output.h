#pragma once
#include <filesystem>

#include "core/file.h"
#include "study/tracks/swarm_view.h"

namespace faba {

/// What SwarmView sees, frame by frame, as CSV under a temporary name, which is gone unless complete() is
/// called: `frame,t_s,signal,x_px,y_px,var_xx_px2,var_xy_px2,var_yy_px2`, the signal in grey px^2 of a scale
/// of 255, image frame; places are empty where no swarm is seen.
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
  bool whole_ = false;
};

}  // namespace faba
