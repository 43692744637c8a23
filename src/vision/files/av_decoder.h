#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "vision/files/ffmpeg.h"
#include "vision/files/frame_grey.h"
#include "vision/files/libav.h"

namespace faba {

/// Thrown at the first sign of damage while several threads decode, see AvStream::read_by_one_thread().
struct Damaged {};

/// An open picture or video file and its decoder, for AvStream.
struct AvDecoder {
  struct CloseIo {
    void operator()(AVIOContext* context) const { FABA_AV(avio_close)(context); }
  };
  using Io = std::unique_ptr<AVIOContext, CloseIo>;
  using Container = std::unique_ptr<AVFormatContext, libav::Free>;
  using Codec = std::unique_ptr<AVCodecContext, libav::Free>;
  using Packet = std::unique_ptr<AVPacket, libav::Free>;
  using Frame = std::unique_ptr<AVFrame, libav::Free>;

  std::filesystem::path path;
  unsigned threads = 1;
  std::optional<double> skipped_to;  // by the last skip_to()
  Io io;                             // declared before the container, which reads through it
  Container container;
  Codec codec;
  // Packets that skip_to() has read, from a key frame on. They are taken before those of the file.
  std::deque<Packet> skimmed;
  // One packet is held back: only the next read reports whether it was truncated.
  Packet held{FABA_AV(av_packet_alloc)()}, incoming{FABA_AV(av_packet_alloc)()};
  Frame frame{FABA_AV(av_frame_alloc)()};
  RawFrame current;  // refers to `frame`
  AVStream* stream = nullptr;

  int width = 0, height = 0, pixel_bits = 0;
  double fps = 0;
  bool still = false, frame_waiting = false, truncated = false;
  std::string probing_error;  // error logged while the file was opened, when its end was already reached
  bool holding = false, error_logged = false, all_read = false;
  bool sought = false;  // by seek()
  // After damage: frames predicted from a lost frame are wrong as well.
  bool need_key_packet = false, need_key_frame = false;
  std::int64_t damaged = 0, delivered = 0;
  std::int64_t sent = 0;  // packets of frames: sent to the decoder, or dropped by skip_to()
  std::string damage;
  std::int64_t first_stamp = AV_NOPTS_VALUE;
  double last_t = 0;

  [[noreturn]] void refuse(const std::string& why) const { throw Error(Errc::input, path.string(), why); }
  void open();
  void open_codec();
  bool decode();
  bool next(RawFrame& out, double& t_s);  // `out` is valid until the next call
  void feed();
  bool read_packet();
  bool take_packet();
  std::int64_t skip_to(double t_s);
  bool seek(double t_s);
  double time_of_packet(const AVPacket& packet, std::int64_t index) const;
  void end_of_file(int result);
  void send(AVPacket& packet);
  void note_damage(const std::string& why);
  double time_of_frame();
};

}  // namespace faba
