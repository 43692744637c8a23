#include "rig/simulated/cells_in_camera.h"

#include <cmath>

namespace faba {

void CellsInCamera::remember(const State& s) {
  const auto x = s.agents["x"], y = s.agents["y"];
  x_.assign(x.begin(), x.end());
  y_.assign(y.begin(), y.end());
  t_ = s.t;
}

const std::vector<CameraCell>& CellsInCamera::look(const State& s, double exposure_time) {
  const auto x = s.agents["x"], y = s.agents["y"];
  const bool rods = s.agents.has("ux") && s.agents.has("uy");
  const bool moving = x_.size() == x.size() && s.t > t_;
  const double scale = moving ? exposure_time / (s.t - t_) / frame_.m_per_px : 0;
  cells_.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec2 p = frame_.image_from_world({double(x[i]), double(y[i])});
    CameraCell& c = cells_[i] = {float(p.x), float(p.y)};
    if (moving) {
      c.dx = float(scale * (double(x[i]) - double(x_[i])));
      c.dy = float(-scale * (double(y[i]) - double(y_[i])));
    }
  }
  if (rods) {
    const auto ux = s.agents["ux"], uy = s.agents["uy"];
    for (std::size_t i = 0; i < x.size(); ++i) {
      cells_[i].ux = ux[i];
      cells_[i].uy = -uy[i];
    }
  }
  return cells_;
}

}  // namespace faba
