#include "vision/files/video_libraries.h"

#include <system_error>
#include <thread>

#include "core/error.h"
#include "vision/files/ffmpeg.h"

namespace faba {
namespace {

void load() { problem_of_video_libraries(); }  // the first use reports it

std::jthread thread_of_loading() {
  try {
    return std::jthread(load);
  } catch (const std::system_error&) {  // no more threads: the first use loads them
    return {};
  }
}

}  // namespace

std::string problem_of_video_libraries() {
  try {
    libav::function("avformat_version");
    return {};
  } catch (const Error& e) {
    return e.reason();
  }
}

void load_video_libraries() { static const std::jthread loading = thread_of_loading(); }

}  // namespace faba
