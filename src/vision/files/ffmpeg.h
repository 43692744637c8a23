#pragma once
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace faba::libav {

/// The address of a function of FFmpeg. Its libraries are loaded by the first call: with their own libraries
/// they are a hundred, which takes longer than a short run, and most calls of the program need none of them.
/// Throws Error(internal) when they cannot be loaded.
void* function(const char* name);

/// Frees objects of FFmpeg.
struct Free {
  void operator()(AVFrame* frame) const;
  void operator()(AVPacket* packet) const;
  void operator()(AVCodecContext* codec) const;
  void operator()(AVFormatContext* input) const;
  void operator()(SwsContext* scaler) const;
};

}  // namespace faba::libav

/// A function of FFmpeg: FABA_AV(av_read_frame)(context, packet). A direct call would link its library.
#define FABA_AV(name)                                                                                \
  (*([] {                                                                                            \
    static auto* const loaded = reinterpret_cast<decltype(&::name)>(::faba::libav::function(#name)); \
    return loaded;                                                                                   \
  }()))
