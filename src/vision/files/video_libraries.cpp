#include "vision/files/video_libraries.h"

#include <thread>

#include "core/error.h"
#include "vision/files/ffmpeg.h"

namespace faba {

void load_video_libraries() {
  static const std::jthread loading([] {
    try {
      libav::function("avformat_version");
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): the first use reports it
    }
  });
}

}  // namespace faba
