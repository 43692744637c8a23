#include "vision/cells/video_background.h"

#include "vision/files/video_reader.h"

namespace faba {

Background video_background(const std::filesystem::path& path, int most_frames,
                            const std::function<void(std::int64_t, std::int64_t)>& progress) {
  VideoReader reader(path);
  BackgroundSampler sampler(most_frames);
  GrayF frame;
  std::int64_t done = 0;
  for (double t_s = 0; reader.read(frame, t_s);) {
    sampler.take(frame);
    if (progress) progress(++done, reader.frames_in_header());
  }
  return sampler.background();
}

}  // namespace faba
