#include "control/centroid.h"

#include <cmath>

namespace faba {

Mat2 flicker_cov(Mat2 before, Mat2 now, double cells) {
  const Mat2 change = now + -1.0 * before;
  // |M| = root of M^2, in the closed form for 2 x 2 matrices.
  const double det = std::abs(change.xx * change.yy - change.xy * change.xy);
  const Mat2 square{change.xx * change.xx + change.xy * change.xy, change.xy * (change.xx + change.yy),
                    change.yy * change.yy + change.xy * change.xy};
  const double trace = std::sqrt(square.xx + square.yy + 2 * det);
  if (!(cells > 0) || !(trace > 0) || !std::isfinite(trace)) return {};
  return 1 / (trace * cells) * (square + Mat2{det, 0, det});
}

Estimate Centroid::update(const Observation& o, bool only_visible) {
  const auto counts = [&](const Detection& d) { return d.in_view || !only_visible; };
  Estimate e;
  e.t = o.t;
  e.centroid = at_;
  double n = 0, sx = 0, sy = 0;
  for (const Detection& d : o.seen)
    if (counts(d)) {
      ++n;
      sx += double(d.x);
      sy += double(d.y);
    }
  e.visible = n;
  if (n > 0) {
    e.centroid = {sx / n, sy / n};
    if (has_centroid_ && o.t > t_) e.velocity = (1 / (o.t - t_)) * (e.centroid - at_);
    at_ = e.centroid;
    t_ = o.t;
    has_centroid_ = true;
  }
  if (n > 1) {
    for (const Detection& d : o.seen)
      if (counts(d)) {
        const double dx = double(d.x) - e.centroid.x, dy = double(d.y) - e.centroid.y;
        e.cov.xx += dx * dx;
        e.cov.xy += dx * dy;
        e.cov.yy += dy * dy;
      }
    e.cov = {e.cov.xx / (n - 1), e.cov.xy / (n - 1), e.cov.yy / (n - 1)};
  }
  return e;
}

}  // namespace faba
