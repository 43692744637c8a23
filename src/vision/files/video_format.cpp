#include "vision/files/video_format.h"
#include "vision/files/ffmpeg.h"

#include <string>

#include "core/error.h"

namespace faba {

FrameRate frame_rate_near(double fps) {
  if (!(fps >= kMinFrameRate && fps <= kMaxFrameRate)) {
    throw Error(Errc::internal, "",
                std::to_string(fps) +
                    " frames per second is out of range; the frame rate must be between 0.001 and 10000");
  }
  const AVRational rate = FABA_AV(av_d2q)(fps, 100000);
  return {rate.num, rate.den};
}

}  // namespace faba
