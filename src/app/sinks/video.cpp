#include <algorithm>
#include <limits>
#include <mutex>

#include "app/sinks/sinks.h"
#include "core/threads/job_thread.h"
#include "vision/files/video_writer.h"

namespace faba {
namespace {

constexpr std::size_t kWaitingBytes = 64u << 20;  // of the pictures that wait for the encoder

/// Frames of a video between two restarts of the encoder: seconds of video, because a second begins with a
/// key frame in any case, with at least kFew frames; fewer if the simulation takes more than some seconds for
/// them. A checkpoint restarts the encoder, too. It waits for the end of a group, so that its time has no
/// effect.
std::uint64_t group_frames(const SinkContext& c) {
  constexpr std::uint64_t kFew = 30;
  // Steps of single cells.
  constexpr double kMostSteps = 4e8;
  if (!c.truth) return std::numeric_limits<std::uint64_t>::max();  // a bench has no checkpoints
  const FrameRate rate = frame_rate_near(c.frame_rate / c.record.video_every);
  const auto second = std::uint64_t(std::max(rate.numerator / rate.denominator, 1));
  const double steps_per_frame = c.record.video_every / (c.frame_rate * c.truth->parts().dt);
  const auto cells = double(std::max<std::size_t>(c.truth->state().agents.size(), 1));
  const double computed = std::min(kMostSteps / (cells * steps_per_frame), double(kFew + second - 1));
  const auto frames = std::uint64_t(std::max(computed, 1.0));
  return frames < second ? frames : frames / second * second;
}

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
        group_(lossless ? 1 : group_frames(c)),
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
    const std::uint64_t number = recorded / std::uint64_t(c_.record.video_every);
    next_ = number + 1;
    const bool kept = c_.kept && c_.kept->keeps(number);
    const Place place{number, kept, kept ? c_.frames->time_of(t) : 0};
    if (c_.draw) {
      RgbImage drawn = spare_.take();
      c_.draw(t, drawn);
      encoding_.add([this, place, picture = std::move(drawn)]() mutable {
        write(picture, place);
        spare_.give(std::move(picture));
      });
    } else if (lossless_ && c_.frames->bits() == 16) {
      encoding_.add([this, picture = c_.frames->deep_picture()] { writer_->write(picture); });
    } else {
      encoding_.add([this, place, picture = c_.frames->picture(t)] { write(*picture, place); });
    }
  }

  void checkpoint(Archive& a) override {
    encoding_.wait();
    std::uint64_t bytes = writer_ ? writer_->sync() : 1;
    a& bytes;
    if (c_.kept) a&* c_.kept;
  }

  bool seamless() const override { return next_ % group_ == 0; }

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
  struct Place {
    std::uint64_t number;  ///< of the frame in the video
    bool kept;             ///< for the report
    double t_s;            ///< of a frame that is kept
  };

  // Time of a frame of a bench; extrapolated after the last one.
  double taken_at(std::size_t frame) const {
    if (frame < times_.size()) return times_[frame];
    return times_.back() + double(frame - times_.size() + 1) * c_.record.video_every / c_.frame_rate;
  }
  template <class Pixel>
  void write(const Image<Pixel>& picture, const Place& place) {
    if (!lossless_ && place.number % group_ == 0) writer_->restart();
    writer_->write(picture);
    if (place.kept) c_.kept->add({small_picture(picture), place.t_s});
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
  std::uint64_t group_;
  std::uint64_t next_ = 0;  ///< number of the next frame; after a resume 0 before the first one
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
