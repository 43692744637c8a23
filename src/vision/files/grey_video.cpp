#include "vision/files/grey_video.h"

namespace faba {

std::int64_t GreyVideo::skip_to(double t_s) { return reader_.bits() > 8 ? 0 : reader_.skip_to(t_s); }

bool GreyVideo::read(GrayF& frame, double& t_s) {
  if (!next(t_s)) return false;
  picture(frame);
  return true;
}

bool GreyVideo::next(double& t_s) {
  if (!reader_.next(t_s)) return false;
  if (greys_) return true;
  if (reader_.bits() > 8) reader_.picture(raw_);
  greys_.emplace(reader_.bits(), raw_);
  return true;
}

void GreyVideo::picture(GrayF& frame, const std::function<void(const GrayF&)>& take) {
  GrayF& full_size = side_ > 1 ? raw_ : frame;
  reader_.picture(full_size);
  if (take) take(full_size);
  greys_->apply(full_size);
  if (side_ > 1) shrink(full_size, side_, frame);
}

}  // namespace faba
