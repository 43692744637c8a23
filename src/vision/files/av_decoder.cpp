#include "vision/files/av_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "vision/files/av_format.h"

namespace faba {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  // limit for corrupt or malicious headers

// The edit list of an MP4 may end before its last packet, which then gives no frame.
bool is_shown(const AVPacket& packet) { return (packet.flags & AV_PKT_FLAG_DISCARD) == 0; }

}  // namespace

void AvDecoder::open() {
  libav::quiet();
  libav::forget_messages();
  AVIOContext* raw_io = nullptr;
  int result = FABA_AV(avio_open)(&raw_io, ("file:" + path.string()).c_str(), AVIO_FLAG_READ);
  if (result < 0) refuse("cannot be opened: " + libav::reason(result));
  io.reset(raw_io);

  const AVInputFormat* kind_by_magic = portable_map(*io);
  AVFormatContext* raw = FABA_AV(avformat_alloc_context)();
  raw->pb = io.get();
  AVDictionary* options = nullptr;
  FABA_AV(av_dict_set)(&options, "protocol_whitelist", "none", 0);  // play lists must not open other files
  result = FABA_AV(avformat_open_input)(&raw, "", kind_by_magic, &options);  // frees `raw` itself on failure
  FABA_AV(av_dict_free)(&options);
  if (result < 0)
    refuse(
        "cannot be read as a picture or video: it is damaged, or of a format that is not supported "
        "(supported: "
        "TIFF, PNG, JPEG, PGM, and videos that FFmpeg reads)" +
        (result == AVERROR_INVALIDDATA ? "" : ": " + libav::reason(result)));
  container.reset(raw);
  const std::string_view kind = container->iformat->name;
  if (is_refused_format(kind)) refuse("is not a picture or video");
  still = is_still(kind);
  if (kind == "jpeg_pipe" && is_jpeg_truncated(path))
    refuse("is damaged or truncated: the end marker of the JPEG is missing");

  libav::forget_messages();
  result = FABA_AV(avformat_find_stream_info)(container.get(), nullptr);
  if (result < 0) refuse("the streams cannot be read: " + libav::reason(result));
  if (io->eof_reached != 0) probing_error = libav::first_message();
  result = FABA_AV(av_find_best_stream)(container.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (result < 0) refuse("contains no video stream");
  stream = container->streams[result];
  if ((stream->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0)
    refuse("is an audio file; its cover picture is not a video");
  open_codec();
}

void AvDecoder::open_codec() {
  const char* name = FABA_AV(avcodec_get_name)(stream->codecpar->codec_id);
  const AVCodec* decoder = FABA_AV(avcodec_find_decoder)(stream->codecpar->codec_id);
  if (decoder == nullptr) {
    refuse(std::string("codec not supported: ") + name + "; convert it to H.264 or PNG");
  }
  codec.reset(FABA_AV(avcodec_alloc_context3)(decoder));
  FABA_AV(avcodec_parameters_to_context)(codec.get(), stream->codecpar);
  codec->thread_count = still ? 1 : static_cast<int>(threads);
  codec->thread_type = FF_THREAD_FRAME;
  codec->max_pixels = kMaxPixels;
  codec->pkt_timebase = stream->time_base;
  // A damaged still image is refused; in a video, damage to side information must not lose the frame.
  codec->err_recognition = AV_EF_CRCCHECK | (still ? AV_EF_EXPLODE | AV_EF_BITSTREAM | AV_EF_BUFFER : 0);
  libav::forget_messages();
  const int result = FABA_AV(avcodec_open2)(codec.get(), decoder, nullptr);
  if (result < 0) refuse(std::string("the ") + name + " stream cannot be decoded: " + libav::reason(result));

  frame_waiting = decode();
  if (!frame_waiting)
    refuse("is damaged or truncated: no complete frame" + (damage.empty() ? "" : "; " + damage));
  first_stamp = frame->best_effort_timestamp;
  width = frame->width;
  height = frame->height;
  pixel_bits = grey_bits(frame->format);
  if (pixel_bits == 0) {
    refuse("pixel format not supported: " + pixel_format_name(frame->format));
  }
  const AVRational mean = stream->avg_frame_rate;
  const AVRational rate = mean.num > 0 && mean.den > 0 ? mean : stream->r_frame_rate;
  if (!still && rate.num > 0 && rate.den > 0) fps = av_q2d(rate);
}

void AvDecoder::note_damage(const std::string& why) {
  if (threads > 1) throw Damaged{};
  ++damaged;
  need_key_packet = true;
  if (!damage.empty()) return;
  damage = (delivered == 0 ? "" : "after " + std::to_string(delivered) + " complete frames ") + why;
}

// Decodes until `frame` holds a complete frame; false at the end.
bool AvDecoder::decode() {
  for (;;) {
    libav::forget_messages();
    const int result = FABA_AV(avcodec_receive_frame)(codec.get(), frame.get());
    if (result == AVERROR_EOF) {
      // With several threads FFmpeg may lose errors of the last frames.
      if (threads > 1 && (truncated || delivered != sent)) throw Damaged{};
      if (need_key_packet) truncated = true;
      return false;
    }
    if (result == AVERROR(EAGAIN)) {
      feed();
    } else if (result < 0) {
      note_damage("a frame cannot be decoded: " + libav::reason(result));
    } else if (frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
      note_damage("parts of a frame are missing");
      need_key_frame = true;
    } else if (need_key_frame && frame->key_frame == 0) {
      ++damaged;
    } else {
      need_key_frame = false;
      return true;
    }
  }
}

double AvDecoder::time_of_frame() {
  const double step = fps > 0 ? 1 / fps : 1;
  double t = delivered == 0 ? 0 : last_t + step;
  const std::int64_t stamp = frame->best_effort_timestamp;
  if (stamp != AV_NOPTS_VALUE && fps > 0) {
    if (first_stamp == AV_NOPTS_VALUE) first_stamp = stamp;
    const double stamped = static_cast<double>(stamp - first_stamp) * av_q2d(stream->time_base);
    if (delivered == 0 || stamped > last_t) t = stamped;  // times increase even if the time stamps do not
  }
  last_t = t;
  return t;
}

bool AvDecoder::next(RawFrame& out, double& t_s) {
  if (!frame_waiting) frame_waiting = decode();
  if (!frame_waiting) return false;
  frame_waiting = false;
  const AVFrame& raw = *frame;
  if (raw.width != width || raw.height != height || grey_bits(raw.format) != pixel_bits) {
    refuse("frame " + std::to_string(delivered) +
           " differs in size or bit depth from the first; split the video there");
  }
  t_s = time_of_frame();
  out = {raw.data, raw.linesize, raw.width, raw.height, raw.format, raw.color_range, raw.colorspace};
  ++delivered;
  return true;
}

// Sends one packet to the decoder, or the end-of-stream signal.
void AvDecoder::feed() {
  while (!all_read || !skimmed.empty() || holding) {
    const bool more = take_packet();
    std::swap(held, incoming);
    const bool ready = std::exchange(holding, more);
    if (ready) return send(*incoming);
  }
  FABA_AV(avcodec_send_packet)(codec.get(), nullptr);
}

// The next packet into `incoming`: of those that skip_to() has read, then of the file.
bool AvDecoder::take_packet() {
  if (skimmed.empty()) return read_packet();
  FABA_AV(av_packet_unref)(incoming.get());
  FABA_AV(av_packet_move_ref)(incoming.get(), skimmed.front().get());
  skimmed.pop_front();
  return true;
}

double AvDecoder::time_of_packet(const AVPacket& packet, std::int64_t index) const {
  const std::int64_t stamp = packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
  if (stamp == AV_NOPTS_VALUE || first_stamp == AV_NOPTS_VALUE) return static_cast<double>(index) / fps;
  return static_cast<double>(stamp - first_stamp) * av_q2d(stream->time_base);
}

// Reads packets up to the time `t_s` without decoding them, and drops those before the last key frame.
// Nothing is skipped after damage, because the numbers of packets and frames differ then.
std::int64_t AvDecoder::skip_to(double t_s) {
  constexpr std::size_t kMaxKept = std::size_t{64} << 20;  // bytes between two key frames, in memory
  constexpr double kRounding = 1e-6;                       // s, of times that are computed from time stamps
  if (still || fps <= 0 || damaged > 0 || (all_read && skimmed.empty())) return 0;
  std::deque<Packet> kept;
  std::size_t bytes = 0;
  std::int64_t dropped = 0, index = sent;
  bool from_key = false;  // `kept` begins with a key frame
  bool more = std::exchange(holding, false);
  if (more) std::swap(incoming, held);
  for (more = more || take_packet(); more; more = bytes < kMaxKept && take_packet()) {
    const double t = time_of_packet(*incoming, index);
    if (is_shown(*incoming)) ++index;
    if ((incoming->flags & AV_PKT_FLAG_KEY) != 0 && t <= t_s + kRounding) {
      dropped += std::ranges::count_if(kept, [](const Packet& packet) { return is_shown(*packet); });
      kept.clear();
      bytes = 0;
      from_key = true;
    }
    bytes += static_cast<std::size_t>(incoming->size);
    kept.emplace_back(FABA_AV(av_packet_alloc)());
    FABA_AV(av_packet_move_ref)(kept.back().get(), incoming.get());
    if (t >= t_s) break;
  }
  for (; !kept.empty(); kept.pop_back()) skimmed.push_front(std::move(kept.back()));
  if (!from_key) return 0;
  FABA_AV(avcodec_flush_buffers)(codec.get());
  frame_waiting = false;
  sent += dropped;
  const std::int64_t skipped = sent - delivered;
  delivered = sent;
  if (!sought) last_t = static_cast<double>(delivered - 1) / fps;
  return skipped;
}

bool AvDecoder::seek(double t_s) {
  if (still || fps <= 0 || first_stamp == AV_NOPTS_VALUE) return false;
  const auto stamp = first_stamp + std::llround(t_s / av_q2d(stream->time_base));
  if (FABA_AV(av_seek_frame)(container.get(), stream->index, stamp, AVSEEK_FLAG_BACKWARD) < 0) return false;
  FABA_AV(avcodec_flush_buffers)(codec.get());
  skimmed.clear();
  FABA_AV(av_packet_unref)(held.get());
  holding = all_read = frame_waiting = need_key_packet = need_key_frame = false;
  // The numbers of packets and frames are not known exactly any more; times come from the time stamps.
  delivered = sent = std::max<std::int64_t>(1, std::llround(t_s * fps));
  last_t = -std::numeric_limits<double>::infinity();
  sought = true;
  return true;
}

// Reads the next packet of the stream into `incoming`. At the end of a truncated file the held packet is
// dropped.
bool AvDecoder::read_packet() {
  for (;;) {
    libav::forget_messages();
    FABA_AV(av_packet_unref)(incoming.get());
    const int result = FABA_AV(av_read_frame)(container.get(), incoming.get());
    error_logged = !libav::first_message().empty() || (result < 0 && error_logged);
    if (result < 0) {
      end_of_file(result);
      return false;
    }
    if (incoming->stream_index == stream->index) return true;
  }
}

void AvDecoder::send(AVPacket& packet) {
  if (is_shown(packet)) ++sent;
  const bool key = (packet.flags & AV_PKT_FLAG_KEY) != 0;
  if ((packet.flags & AV_PKT_FLAG_CORRUPT) != 0) {
    note_damage("a frame is incomplete");
  } else if (need_key_packet && !key) {
    ++damaged;
  } else {
    need_key_packet = false;
    libav::forget_messages();
    const int result = FABA_AV(avcodec_send_packet)(codec.get(), &packet);
    if (result < 0) note_damage("a frame cannot be decoded: " + libav::reason(result));
  }
}

void AvDecoder::end_of_file(int result) {
  all_read = true;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path));
  bool missing = container->iformat->name == std::string_view("avi") && is_avi_truncated(path);
  for (int i = 0; i < FABA_AV(avformat_index_get_entries_count)(stream) && !missing; ++i) {
    const AVIndexEntry* entry = FABA_AV(avformat_index_get_entry)(stream, i);
    missing = entry->pos + entry->size > size;
  }
  truncated = missing || error_logged || !probing_error.empty() || result != AVERROR_EOF;
  const std::string complaint = libav::first_message().empty() ? probing_error : libav::first_message();
  if (error_logged && holding) held->flags |= AV_PKT_FLAG_CORRUPT;
  if (truncated && damage.empty()) {
    damage = "the file is truncated" + (complaint.empty() ? "" : " (" + complaint + ")");
  }
}

}  // namespace faba
