#include "study/tracks/swarm_view.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "vision/image/kernels/arithmetic.h"

namespace faba {
namespace {

ForegroundOptions options_of(const TrackSurvey& s) {
  ForegroundOptions o;
  o.cell_px = std::clamp(s.size_px, 1.0, 20.0);
  o.polarity = s.polarity == Polarity::both ? Polarity::automatic : s.polarity;
  o.learn = s.temporal;  // else each frame has its own background
  return o;
}

}  // namespace

SwarmView::SwarmView(const TrackSurvey& survey, int bits)
    : foreground_(options_of(survey)), region_(survey.region) {
  // The scale keeps black at 0, so that the absorbed fraction of the light is preserved.
  if (bits > 8 && survey.white > 0) scale_ = 255 / survey.white;
  std::vector<float> noise = survey.background.noise_sd.px;
  noise_ = double(scale_ * robust_spread_low(noise).median);
  if (!survey.temporal) return;
  Background b = survey.background;
  multiply(b.level, scale_);
  foreground_.set_background(b);
}

SwarmMoments SwarmView::take(const GrayF& frame, double t_s) {
  GrayF grey = cropped(frame, region_);
  if (scale_ != 1) multiply(grey, scale_);
  foreground_.take(grey, noise_, t_s - last_s_);
  last_s_ = t_s;
  SwarmMoments m = foreground_.moments();
  m.centroid_image = m.centroid_image + Vec2{double(region_.col), double(region_.row)};
  return m;
}

}  // namespace faba
