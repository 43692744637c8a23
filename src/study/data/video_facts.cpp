#include "study/data/video_facts.h"

#include "study/data/run_video.h"
#include "vision/files/video_reader.h"

namespace faba {

VideoFacts video_facts(const std::filesystem::path& path) {
  const VideoReader video(run_video(path).file);
  return {video.width(), video.height(), video.fps(), video.frames_in_header()};
}

}  // namespace faba
