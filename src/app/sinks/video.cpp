#include <algorithm>
#include <mutex>

#include "app/sinks/sinks.h"
#include "core/threads/job_thread.h"
#include "vision/files/video_writer.h"

namespace faba {
namespace {

constexpr std::size_t kWaitingBytes = 64u << 20;  // of the pictures that wait for the encoder

/// Pictures that have been encoded. A large picture is used again: to get new memory from the system takes
/// as long as to draw a million cells.
class SparePictures {
 public:
  RgbImage take() {
    const std::lock_guard lock(mutex_);
    if (pictures_.empty()) return {};
    RgbImage last = std::move(pictures_.back());
    pictures_.pop_back();
    return last;
  }
  void give(RgbImage picture) {
    const std::lock_guard lock(mutex_);
    pictures_.push_back(std::move(picture));
  }

 private:
  std::mutex mutex_;
  std::vector<RgbImage> pictures_;
};

/// Encodes in its own thread.
class Video final : public RunSink {
 public:
  Video(const SinkContext& c, bool lossless, std::uint64_t keep)
      : c_(c),
        lossless_(lossless),
        part_(c.dir / (lossless ? "video.avi.part" : "video.mp4.part")),
        final_(c.dir / (lossless ? "video.avi" : "video.mp4")),
        encoding_(std::clamp<std::size_t>(kWaitingBytes / picture_bytes(c), 1, 16)) {
    // The process was killed after this file was completed and before the run was: the file is complete.
    if (keep > 0 && !std::filesystem::exists(part_) && std::filesystem::exists(final_)) return;
    writer_.emplace(part_, lossless ? VideoFormat::lossless_avi : VideoFormat::mp4, c.frame.width,
                    c.frame.height, c.frame_rate / c.record.video_every, keep, grey(c, lossless));
  }

  void take(const Tick& t) override {
    const std::uint64_t recorded = t.index - c_.recorded.first;
    if (recorded % std::uint64_t(c_.record.video_every)) return;
    if (!writer_) return;
    if (c_.jitter && !c_.frames->planned_time(t.index)) times_.push_back(c_.frames->time_of(t));
    const bool kept = c_.kept && c_.kept->keeps(recorded / std::uint64_t(c_.record.video_every));
    const double t_s = kept ? c_.frames->time_of(t) : 0;
    if (c_.draw) {
      RgbImage drawn = spare_.take();
      c_.draw(t, drawn);
      encoding_.add([this, kept, t_s, picture = std::move(drawn)]() mutable {
        write(picture, kept, t_s);
        spare_.give(std::move(picture));
      });
    } else if (lossless_ && c_.frames->bits() == 16) {
      encoding_.add([this, picture = c_.frames->deep_picture()] { writer_->write(picture); });
    } else {
      encoding_.add([this, kept, t_s, picture = c_.frames->picture(t)] { write(*picture, kept, t_s); });
    }
  }

  void checkpoint(Archive& a) override {
    encoding_.wait();
    std::uint64_t bytes = writer_ ? writer_->sync() : 1;
    a& bytes;
    if (c_.kept) a&* c_.kept;
  }

  void finish(bool keep) override {
    if (!writer_) return;
    encoding_.wait();
    if (writer_->sync() == 0) return;  // the run was stopped before the recorded part
    if (c_.jitter) {
      const auto every = std::uint64_t(c_.record.video_every);
      const std::uint64_t first = c_.recorded.first;
      // A video starts at 0 s.
      const double start = first > 0 ? c_.frames->planned_time(first).value_or(0) : 0;
      writer_->finish(final_, keep, [&](long long frame) {
        const auto planned = c_.frames->planned_time(first + std::uint64_t(frame) * every);
        return planned ? *planned - start : taken_at(std::size_t(frame));
      });
    } else {
      writer_->finish(final_, keep);
    }
  }

 private:
  // Time of a frame of a bench; extrapolated after the last one.
  double taken_at(std::size_t frame) const {
    if (frame < times_.size()) return times_[frame];
    return times_.back() + double(frame - times_.size() + 1) * c_.record.video_every / c_.frame_rate;
  }
  template <class Pixel>
  void write(const Image<Pixel>& picture, bool kept, double t_s) {
    writer_->write(picture);
    if (kept) c_.kept->add({small_picture(picture), t_s});
  }
  static std::size_t picture_bytes(const SinkContext& c) {
    return sizeof(Rgb) * std::size_t(c.frame.width) * std::size_t(c.frame.height);
  }
  static VideoPixels grey(const SinkContext& c, bool lossless) {
    if (c.draw) return VideoPixels::colour;
    return lossless && c.frames->bits() == 16 ? VideoPixels::grey16 : VideoPixels::grey8;
  }

  SinkContext c_;
  bool lossless_;
  std::filesystem::path part_, final_;
  std::optional<VideoWriter> writer_;
  SparePictures spare_;
  std::vector<double> times_;  ///< s, times of the frames of a bench, which are not known in advance
  JobThread encoding_;         ///< last: its jobs use the other members
};

}  // namespace

std::unique_ptr<RunSink> video_sink(const SinkContext& c, bool lossless, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  if (resume && c.kept) *resume&* c.kept;
  return std::make_unique<Video>(c, lossless, keep);
}

}  // namespace faba
