#include "study/pages/tracks/swarm_output.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

namespace faba {
SwarmOutput::SwarmOutput(std::filesystem::path path, const TrackSurvey& survey, int bits)
    : path_(std::move(path)), file_(temporary_name(path_), 0, path_), view_(survey, bits) {
  file_.append("frame,t_s,signal,x_px,y_px,var_xx_px2,var_xy_px2,var_yy_px2\n");
}

SwarmOutput::~SwarmOutput() {
  if (complete_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_name(path_), ignored);
}

void SwarmOutput::write(std::uint64_t index, double t_s, const GrayF& frame) {
  const SwarmMoments m = view_.take(frame, t_s);
  if (m.signal > 0)
    file_.append(fmt::format("{},{:.6f},{:.6g},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f}\n", index, t_s, m.signal,
                             m.centroid_image.x, m.centroid_image.y, m.cov_px2.xx, m.cov_px2.xy,
                             m.cov_px2.yy));
  else
    file_.append(fmt::format("{},{:.6f},0,,,,,\n", index, t_s));
}

void SwarmOutput::complete() {
  file_.sync();
  file_.close();
  rename_complete(temporary_name(path_), path_);
  complete_ = true;
}

}  // namespace faba
