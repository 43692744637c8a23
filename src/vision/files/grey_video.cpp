#include "vision/files/grey_video.h"

namespace faba {

bool GreyVideo::read(GrayF& frame, double& t_s) {
  GrayF& whole = side_ > 1 ? raw_ : frame;
  if (!reader_.read(whole, t_s)) return false;
  if (!greys_) greys_.emplace(reader_.bits(), whole);
  greys_->apply(whole);
  if (side_ > 1) shrink(whole, side_, frame);
  return true;
}

}  // namespace faba
