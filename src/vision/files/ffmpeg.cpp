#include "vision/files/ffmpeg.h"

#include <dlfcn.h>

#include <array>
#include <string>

#include "core/error.h"

namespace faba::libav {
namespace {

// The libraries against whose headers the program was compiled. The others are dependencies of the first one.
constexpr std::array kLibraries = {"libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR),
                                   "libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR)};

std::array<void*, kLibraries.size()> load() {
  std::array<void*, kLibraries.size()> handles{};
  for (std::size_t i = 0; i < handles.size(); ++i) {
    handles[i] = dlopen(kLibraries[i], RTLD_LAZY | RTLD_LOCAL);
    if (handles[i] == nullptr)
      throw Error(Errc::internal, kLibraries[i],
                  std::string("the library for videos and pictures cannot be loaded: ") + dlerror() +
                      "; install the FFmpeg libraries of your system");
  }
  return handles;
}

}  // namespace

void* function(const char* name) {
  static const std::array handles = load();
  for (void* library : handles)
    if (void* address = dlsym(library, name)) return address;
  throw Error(Errc::internal, name,
              "is not a function of this FFmpeg; install the version that Faba was built with");
}

void Free::operator()(AVFrame* frame) const { FABA_AV(av_frame_free)(&frame); }
void Free::operator()(AVPacket* packet) const { FABA_AV(av_packet_free)(&packet); }
void Free::operator()(AVCodecContext* codec) const { FABA_AV(avcodec_free_context)(&codec); }
void Free::operator()(AVFormatContext* input) const { FABA_AV(avformat_close_input)(&input); }
void Free::operator()(SwsContext* scaler) const { FABA_AV(sws_freeContext)(scaler); }

}  // namespace faba::libav
