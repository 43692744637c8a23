#include "study/flow/flow_check.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "vision/image/picture_noise.h"

namespace faba {
namespace {

// An error of 25 % of the displacement leaves 0.25^2 of the difference, one of 50 % leaves 0.5^2. The default
// method has an error of 25 % on the pictures of docs/guide/measure.md.
constexpr double kDoubtfulError = 0.25, kPoorError = 0.5;
constexpr double kNoisePart = 0.5, kOnlyNoise = 0.8;  // of the mean square difference; assumed
constexpr double kMoves = 0.1;  // px: smaller displacements are not distinguished from none
// Smaller eigenvalue of the gradient products over the larger one (assumed): structures without corners.
constexpr double kStripes = 0.05;
constexpr double kChanged = 3;  // standard deviations of the noise

double at(const GrayF& p, double x, double y) {
  const int left = int(x), top = int(y);
  const double fx = x - left, fy = y - top;
  return (1 - fy) * ((1 - fx) * double(p.at(left, top)) + fx * double(p.at(left + 1, top))) +
         fy * ((1 - fx) * double(p.at(left, top + 1)) + fx * double(p.at(left + 1, top + 1)));
}

}  // namespace

void FlowCheck::add(const GrayF& a, const GrayF& b, const Flow& flow, double side) {
  const double noise_a = picture_noise(a), noise_b = picture_noise(b);
  const double noise = noise_a * noise_a + noise_b * noise_b, changed = kChanged * std::sqrt(noise);
  double grey = 0, gradient = 0;
  std::size_t n = 0;
  for (int r = 1; r + 1 < a.height; ++r)
    for (int c = 1; c + 1 < a.width; ++c) {
      const double x = c + double(flow.u.at(c, r)) / side, y = r + double(flow.v.at(c, r)) / side;
      if (!(x >= 0 && y >= 0 && x < a.width - 1 && y < a.height - 1)) continue;
      const double here = double(a.at(c, r)), was = double(b.at(c, r)) - here, is = at(b, x, y) - here;
      const double gx = double(a.at(c + 1, r) - a.at(c - 1, r)) / 2,
                   gy = double(a.at(c, r + 1) - a.at(c, r - 1)) / 2;
      before_ += was * was;
      after_ += is * is;
      noise_ += noise;
      grey += was;
      gradient += gx * gx + gy * gy;
      ++n;
      if (std::fabs(was) < changed) continue;
      xx_ += gx * gx - noise_a * noise_a / 2;
      xy_ += gx * gy;
      yy_ += gy * gy - noise_a * noise_a / 2;
      ++changed_;
    }
  ++pairs_;
  if (n > 0 && gradient > 0)
    light_px_ += side * std::fabs(grey) / double(n) / std::sqrt(gradient / double(n));
}

std::optional<double> FlowCheck::unexplained() const {
  return before_ > 0 ? std::optional(after_ / before_) : std::nullopt;
}

void FlowCheck::warn_residual(std::vector<Warning>& out) const {
  const double motion = before_ - noise_, left = after_ - noise_;
  if (noise_part() > kOnlyNoise || !(motion > 0)) return;
  const double error = std::sqrt(std::max(0.0, left / motion));
  if (error < kDoubtfulError) return;
  out.push_back(
      {"displacement",
       "the flow does not explain the difference of the frames: objects move by more than their "
       "size or in different directions at one place, the light or the focus changes, or the video was coded",
       fmt::format("{:.0f} % of the mean square difference remains after the motion is undone, more than "
                   "the noise; an error of about {:.0f} % of the displacement",
                   100 * *unexplained(), 100 * std::min(1.0, error)),
       "use a higher frame rate, --method dis for large displacements, or a pyramid",
       error > kPoorError ? Quality::poor : Quality::doubtful});
}

void FlowCheck::warn_noise(std::vector<Warning>& out) const {
  if (noise_part() < kNoisePart) return;
  out.push_back(
      {"noise",
       "the difference of the frames is mostly noise: the flow is that of the noise where nothing moves",
       fmt::format("{:.0f} % of the mean square difference", 100 * std::min(1.0, noise_part())),
       "use more light or contrast, or compare frames that are further apart",
       noise_part() > kOnlyNoise ? Quality::poor : Quality::doubtful});
}

void FlowCheck::warn_light(double mean_speed_px, std::vector<Warning>& out) const {
  const double imitated = light_px_ / pairs_;
  if (imitated < kMoves + kDoubtfulError * mean_speed_px) return;
  out.push_back(
      {"light", "the brightness of the frames changes, which the flow takes for motion",
       fmt::format("the change of the mean grey level is that of a displacement by {:.2g} px", imitated),
       "use a constant light and exposure, or divide each frame by its mean",
       imitated > kMoves + kPoorError * mean_speed_px ? Quality::poor : Quality::doubtful});
}

void FlowCheck::warn_stripes(std::vector<Warning>& out) const {
  if (changed_ < 100) return;  // too few for a statement
  const double mean = (xx_ + yy_) / 2, spread = std::hypot((xx_ - yy_) / 2, xy_);
  const double ratio = (mean - spread) / (mean + spread);
  if (!(mean + spread > 0) || ratio > kStripes) return;
  out.push_back(
      {"aperture",
       "the moving structure consists of lines in one direction: a displacement along them cannot be seen",
       fmt::format("the gradient along the lines is {:.2g} of that across them",
                   std::sqrt(std::max(0.0, ratio))),
       "use only the component across the lines", Quality::doubtful});
}

std::vector<Warning> FlowCheck::warnings(double mean_speed_px) const {
  std::vector<Warning> out;
  if (pairs_ == 0 || !(before_ > 0)) return out;
  warn_noise(out);
  warn_residual(out);
  warn_light(mean_speed_px, out);
  warn_stripes(out);
  return out;
}

}  // namespace faba
