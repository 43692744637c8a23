#include "vision/files/grey_video.h"

namespace faba {

bool GreyVideo::read(GrayF& frame, double& t_s) {
  GrayF& full_size = side_ > 1 ? raw_ : frame;
  if (!reader_.read(full_size, t_s)) return false;
  if (!greys_) greys_.emplace(reader_.bits(), full_size);
  greys_->apply(full_size);
  if (side_ > 1) shrink(full_size, side_, frame);
  return true;
}

}  // namespace faba
