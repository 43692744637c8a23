#include "study/motion/video_look.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "vision/image/kernels/frame_change.h"
#include "vision/image/picture_noise.h"

namespace faba {
namespace {

// Assumed. A spot's flow is proportional to its size for displacements beyond it (docs/theory/video.md, A22),
// and noise adds to every flow.
constexpr double kSameSize = 1.2, kSameNoise = 1.5;  // ratios

double imitated_px_by(const FrameChange& change) {
  return change.gradient > 0 ? std::fabs(change.mean) / std::sqrt(change.gradient) : 0;
}

bool usable(const std::shared_ptr<const GrayF>& frame) {
  return frame && frame->width >= 3 && frame->height >= 3;
}

}  // namespace

void LightChange::add(std::shared_ptr<const GrayF> frame) {
  if (!usable(frame)) return;
  if (before_) {
    imitated_px_ += imitated_px_by(frame_change(*before_, *frame));
    ++pairs_;
  }
  before_ = std::move(frame);
}

double LightChange::imitated_px() const { return pairs_ > 0 ? imitated_px_ / pairs_ : 0; }

void VideoLook::add(std::shared_ptr<const GrayF> frame) {
  if (!usable(frame)) return;
  if (!before_) {
    before_ = std::move(frame);
    return;
  }
  const FrameChange now = frame_change(*before_, *frame);
  const double sd = picture_noise(*frame);
  noise_ += sd * sd;
  change_ += now.squared;
  gradient_ += now.slope;
  imitated_px_ += imitated_px_by(now);
  ++pairs_;
  before_ = std::move(frame);
}

double VideoLook::noise() const { return std::sqrt(noise_ / pairs_); }

std::optional<double> VideoLook::size_px() const {
  // A difference of two frames has twice the variance of the noise, a central difference in two directions
  // the same.
  const double change = change_ - 2 * noise_, gradient = gradient_ - 2 * noise_;
  if (!(change > 0.2 * change_ && gradient > 0.2 * gradient_)) return std::nullopt;
  return std::sqrt(change / gradient);
}

double VideoLook::imitated_px() const { return imitated_px_ / pairs_; }

std::vector<Warning> look_warnings(const VideoLook& reference, const VideoLook& run, double threshold_px) {
  std::vector<Warning> out;
  if (reference.empty() || run.empty()) return out;
  const double noise = run.noise() / reference.noise();
  if (std::max(noise, 1 / noise) > kSameNoise)
    out.push_back({"noise", "the noise of the videos differs, which contributes to their distance",
                   fmt::format("{:.2g} grey levels; reference: {:.2g}", run.noise(), reference.noise()),
                   "compare videos of the same camera and light, or render the noise of the camera"});
  const auto size = run.size_px(), as = reference.size_px();
  if (size && as && std::max(*size / *as, *as / *size) > kSameSize)
    out.push_back({"focus",
                   "the moving objects differ in size: focus or magnification differ, and with them the flow",
                   fmt::format("{:.2g} px; reference: {:.2g} px", *size, *as),
                   "compare videos with the same focus and magnification"});
  else if (size.has_value() != as.has_value())
    out.push_back({"contrast", "in one of the videos the motion is not distinguished from the noise",
                   as ? "this video" : "the reference", "use more light or contrast"});
  for (const auto& [look, name] : {std::pair{&reference, "the reference"}, std::pair{&run, "this video"}})
    if (look->imitated_px() > threshold_px)
      out.push_back(
          {"light", "the brightness changes from frame to frame, which counts as motion everywhere",
           fmt::format(
               "{}: the mean change is that of a displacement by {:.2g} px; the threshold is {:.2g} px", name,
               look->imitated_px(), threshold_px),
           "use a constant light and exposure, or divide each frame by its mean"});
  return out;
}

}  // namespace faba
