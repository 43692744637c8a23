#include "vision/files/remux.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "vision/files/ffmpeg.h"
#include "vision/files/libav.h"

namespace faba {
namespace {

constexpr std::uintmax_t kLargeFile = 32u << 20;  // bytes

using Packet = std::unique_ptr<AVPacket, libav::Free>;
using Input = std::unique_ptr<AVFormatContext, libav::Free>;
struct FreeOutput {
  void operator()(AVFormatContext* container) const {
    FABA_AV(avio_closep)(&container->pb);
    FABA_AV(avformat_free_context)(container);
  }
};
using Output = std::unique_ptr<AVFormatContext, FreeOutput>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int result) {
  throw Error(Errc::internal, path.string(), what + ": " + libav::reason(result));
}

std::string file_url(const std::filesystem::path& path) { return "file:" + path.string(); }

// The part of an H.264 key frame before its first slice: the parameter sets, which MP4 stores once.
std::span<const std::uint8_t> headers_of(const AVPacket& key_frame) {
  const std::span<const std::uint8_t> all(key_frame.data, static_cast<std::size_t>(key_frame.size));
  constexpr int kSlice = 1, kKeySlice = 5;
  for (std::size_t i = 0; i + 3 < all.size(); ++i) {
    if (all[i] != 0 || all[i + 1] != 0 || all[i + 2] != 1) continue;
    const int type = all[i + 3] & 31;
    if (type == kSlice || type == kKeySlice) return all.first(i);
  }
  return all;
}

class Remuxer {
 public:
  Remuxer(const std::filesystem::path& part, VideoFormat format, FrameRate rate, const FrameEncoder& encoder,
          const std::filesystem::path& to, const std::function<double(long long)>& time_s)
      : part_(part),
        to_(to),
        mp4_(format == VideoFormat::mp4),
        rate_(rate),
        encoder_(encoder),
        time_s_(mp4_ ? time_s : nullptr) {}
  // Writes the complete `temporary`; errors name `to`.
  long long write(const std::filesystem::path& temporary) {
    open_input();
    if (!read_frame()) {
      throw Error(Errc::internal, part_.string(), "contains no frames; the video cannot be finished");
    }
    open_output(temporary);
    const long long frames = copy_frames();
    finish();
    return frames;
  }

 private:
  void open_input();
  bool read_frame();
  void describe(AVStream& stream) const;
  void open_output(const std::filesystem::path& temporary);
  long long copy_frames();
  void finish();
  AVRational tick() const {
    return time_s_ ? AVRational{1, 1000000} : AVRational{rate_.denominator, rate_.numerator};
  }
  std::int64_t stamp(long long frame) const {
    return time_s_ ? std::llround(time_s_(frame) * 1e6) : std::int64_t{frame};
  }

  const std::filesystem::path &part_, &to_;
  const bool mp4_;
  const FrameRate rate_;
  const FrameEncoder& encoder_;
  const std::function<double(long long)> time_s_;  // empty: regular times
  Input in_;
  Output out_;
  const Packet packet_{FABA_AV(av_packet_alloc)()};
};

void Remuxer::open_input() {
  libav::forget_messages();
  AVFormatContext* raw = nullptr;
  AVDictionary* options = nullptr;
  FABA_AV(av_dict_set)(&options, "pattern_type", "none", 0);
  // Bytes to read at a time; the first packet of PNG files would be the entire file.
  FABA_AV(av_dict_set)(&options, mp4_ ? "raw_packet_size" : "frame_size", "65536", 0);
  const AVInputFormat* kind = FABA_AV(av_find_input_format)(mp4_ ? "h264" : "png_pipe");
  const int result = FABA_AV(avformat_open_input)(&raw, file_url(part_).c_str(), kind, &options);
  FABA_AV(av_dict_free)(&options);
  if (result < 0) fail(part_, "the recorded frames cannot be read", result);
  in_.reset(raw);
}

bool Remuxer::read_frame() {
  const int result = FABA_AV(av_read_frame)(in_.get(), packet_.get());
  if (result < 0 && result != AVERROR_EOF) fail(part_, "the recorded frames cannot be read", result);
  return result >= 0;
}

// From the encoder: avformat_find_stream_info() would decode frames, which takes longer than a short run.
void Remuxer::describe(AVStream& stream) const {
  AVCodecParameters& parameters = *stream.codecpar;
  FABA_AV(avcodec_parameters_from_context)(&parameters, &encoder_.codec());
  parameters.codec_tag = mp4_ ? MKTAG('a', 'v', 'c', '1') : MKTAG('M', 'P', 'N', 'G');
  parameters.bit_rate = 0;  // not a property of the frames
  parameters.field_order = AV_FIELD_PROGRESSIVE;
  stream.time_base = tick();
  stream.avg_frame_rate = {rate_.numerator, rate_.denominator};
  if (!mp4_) return;
  const auto headers = headers_of(*packet_);
  auto* copy = static_cast<std::uint8_t*>(FABA_AV(av_mallocz)(headers.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (copy == nullptr) fail(to_, "cannot be written", AVERROR(ENOMEM));
  std::ranges::copy(headers, copy);
  parameters.extradata = copy;
  parameters.extradata_size = int(headers.size());
}

void Remuxer::open_output(const std::filesystem::path& temporary) {
  libav::forget_messages();
  AVFormatContext* raw = nullptr;
  int result = FABA_AV(avformat_alloc_output_context2)(&raw, nullptr, mp4_ ? "mp4" : "avi",
                                                       file_url(temporary).c_str());
  if (result < 0) fail(to_, "this FFmpeg does not have the container format", result);
  out_.reset(raw);
  raw->flags |= AVFMT_FLAG_BITEXACT;  // no version and no date: reproducible bytes
  describe(*FABA_AV(avformat_new_stream)(raw, nullptr));
  result = FABA_AV(avio_open)(&raw->pb, file_url(temporary).c_str(), AVIO_FLAG_WRITE);
  if (result < 0) fail(to_, "cannot be written", result);
  AVDictionary* options = nullptr;
  // The index at the start of the file lets a browser play it while it loads. To move it there, a large file
  // would be written twice.
  const bool small = std::filesystem::file_size(part_) < kLargeFile;
  if (mp4_ && small) FABA_AV(av_dict_set)(&options, "movflags", "+faststart", 0);
  result = FABA_AV(avformat_write_header)(raw, &options);
  FABA_AV(av_dict_free)(&options);
  if (result < 0) fail(to_, "cannot be written", result);
}

long long Remuxer::copy_frames() {
  AVStream* stream = out_->streams[0];
  long long frames = 0;
  do {
    packet_->stream_index = 0;
    packet_->pts = packet_->dts = stamp(frames);
    packet_->duration = std::max<std::int64_t>(1, stamp(frames + 1) - stamp(frames));
    packet_->pos = -1;
    FABA_AV(av_packet_rescale_ts)(packet_.get(), tick(), stream->time_base);
    const int result = FABA_AV(av_write_frame)(out_.get(), packet_.get());
    FABA_AV(av_packet_unref)(packet_.get());
    if (result < 0) fail(to_, "cannot be written", result);
    ++frames;
  } while (read_frame());
  return frames;
}

void Remuxer::finish() {
  libav::forget_messages();
  int result = FABA_AV(av_write_trailer)(out_.get());
  FABA_AV(avio_flush)(out_->pb);
  if (result >= 0) result = out_->pb->error;
  const int closed = FABA_AV(avio_closep)(&out_->pb);
  if (result >= 0) result = closed;
  if (result < 0) fail(to_, "cannot be written", result);
}

}  // namespace

long long remux(const std::filesystem::path& part, VideoFormat format, FrameRate rate,
                const FrameEncoder& encoder, const std::filesystem::path& to,
                const std::function<double(long long)>& time_s) {
  libav::quiet();
  const std::filesystem::path temporary = to.string() + ".tmp";
  try {
    const long long frames = Remuxer(part, format, rate, encoder, to, time_s).write(temporary);
    rename_complete(temporary, to);
    return frames;
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace faba
