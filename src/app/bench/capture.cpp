#include "app/bench/capture.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "app/bench/memory.h"
#include "app/sinks/run_files.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/monotonic.h"
#include "rig/bench/camera_feed.h"
#include "vision/files/frame_encoder.h"
#include "vision/files/frame_interval.h"
#include "vision/files/tiff_export.h"
#include "vision/files/video_writer.h"

namespace faba {
namespace {

constexpr std::size_t kBacklog = 64;       // maximum number of frames that wait for the disk
constexpr double kMinimumMemory = 0.05;    // fraction of all memory, below which a buffered capture stops
constexpr double kStopPollPeriod = 0.1;    // s
constexpr std::uint64_t kMemoryEvery = 8;  // frames between checks of the memory

// Destination of the pictures, with the table of their times.
class Store {
 public:
  Store(const std::filesystem::path& times) : times_(times) { times_.append("frame,camera_frame,t_s\n"); }
  virtual ~Store() = default;
  void put(const CameraFrame& f, double t) {
    write(*f.image);
    times_.append(fmt::format("{},{},{:.6f}\n", at_.size(), f.number, t));
    at_.push_back(t);
  }
  virtual void finish() {
    times_.sync();
    times_.close();
  }
  virtual std::string unfinished_path() const = 0;  ///< location of the pictures before finish()
  std::uint64_t size() const { return at_.size(); }
  /// The reason of an error, and where the frames are that were recorded before it.
  std::string kept_frames(const Error& e) const {
    return fmt::format("{}; {} recorded frames are in {}", e.reason(), size(), unfinished_path());
  }

 protected:
  virtual void write(const Gray8& picture) = 0;
  std::vector<double> at_;  ///< s, time of each picture

 private:
  OutputFile times_;
};

class VideoStore final : public Store {
 public:
  VideoStore(const CaptureJob& job, const Camera& camera, double rate)
      : Store(job.out.string() + ".csv"),
        job_(job),
        rate_(rate),
        out_(job.out),
        writer_(job.out.string() + ".part",
                job.format == "mp4" ? VideoFormat::mp4 : VideoFormat::lossless_avi, camera.width(),
                camera.height(), rate, 0, VideoPixels::grey8) {}
  std::string unfinished_path() const override { return out_.string() + ".part"; }
  void finish() override {
    if (at_.empty()) {  // without pictures no files are kept
      std::error_code ec;
      std::filesystem::remove(out_.string() + ".part", ec);
      std::filesystem::remove(out_.string() + ".csv", ec);
      return;
    }
    Store::finish();
    if (job_.format == "tif") return write_stack();
    writer_.finish(out_, false, [this](long long i) {
      const auto k = std::size_t(i);
      return k < at_.size() ? at_[k] : 2 * at_.back() - at_[at_.size() > 1 ? at_.size() - 2 : 0];
    });
  }

 private:
  void write(const Gray8& picture) override { writer_.write(picture); }
  // During the capture a stack is a lossless video, which a crash leaves readable.
  void write_stack() {
    writer_.sync();
    const std::optional<FrameInterval> interval = frame_interval(at_);
    VideoReader recorded(unfinished_path(), interval ? 1 / interval->s : rate_);
    try {
      export_tiff(recorded, {.out = out_, .um_per_px = job_.um_per_px});
    } catch (const Error& e) {
      throw Error(e.code(), e.where(), kept_frames(e));
    }
    std::error_code ec;
    std::filesystem::remove(unfinished_path(), ec);
  }
  const CaptureJob& job_;
  double rate_;  ///< Hz
  std::filesystem::path out_;
  VideoWriter writer_;
};

class PictureStore final : public Store {
 public:
  /// `mark`: the file `incomplete` in the folder, which finish() removes.
  PictureStore(const CaptureJob& job, const Camera& camera, FileLock mark)
      : Store(job.out / "times.csv"),
        mark_(std::move(mark)),
        job_(job),
        colour_(job.format == "ppm"),
        encoder_(kind_of(job.format), camera.width(), camera.height(), {}, job.out.string()) {}
  std::string unfinished_path() const override { return job_.out.string(); }
  void finish() override {
    std::error_code ec;
    if (at_.empty())  // without pictures no files are kept
      std::filesystem::remove(job_.out / "times.csv", ec);
    else
      Store::finish();
    mark_.complete();
  }

 private:
  static FrameEncoder::Kind kind_of(const std::string& format) {
    using enum FrameEncoder::Kind;
    return format == "pgm" ? pgm : format == "ppm" ? ppm : format == "tiff" ? tiff : png_grey;
  }
  void write(const Gray8& picture) override {
    std::span<const std::uint8_t> bytes;
    if (colour_) {
      rgb_ = RgbImage(picture.width, picture.height);
      for (std::size_t i = 0; i < picture.px.size(); ++i)
        rgb_.px[i] = {picture.px[i], picture.px[i], picture.px[i]};
      bytes = encoder_.encode(rgb_);
    } else {
      bytes = encoder_.encode(picture);
    }
    write_file(job_.out / fmt::format("frame-{:06}.{}", size(), job_.format),
               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  FileLock mark_;
  const CaptureJob& job_;
  bool colour_;
  FrameEncoder encoder_;
  RgbImage rgb_;
};

std::unique_ptr<Store> store_for(const CaptureJob& job, const Camera& camera) {
  std::error_code ec;
  const bool exists = std::filesystem::exists(job.out, ec);
  if (job.format == "mp4" || job.format == "avi" || job.format == "tif") {
    if (exists && !job.force)
      throw Error(Errc::usage, job.out.string(),
                  "already exists; choose another --out, or --force to replace it");
    if (!job.out.parent_path().empty()) std::filesystem::create_directories(job.out.parent_path(), ec);
    const double rate = camera.rate() > 0 ? camera.rate() : 25;
    return std::make_unique<VideoStore>(job, camera,
                                        job.every > 0 ? 1 / job.every : rate / double(job.one_of));
  }
  if (exists && !(std::filesystem::is_directory(job.out, ec) && std::filesystem::is_empty(job.out, ec)))
    throw Error(Errc::usage, job.out.string(),
                "already exists and is not an empty folder; choose another --out");
  std::filesystem::create_directories(job.out, ec);
  if (ec) throw Error(Errc::usage, job.out.string(), "cannot be created: " + ec.message());
  FileLock mark(job.out / run_files::kMarker, job.out,
                "This capture is not complete. The pictures that times.csv lists are valid.\n");
  return std::make_unique<PictureStore>(job, camera, std::move(mark));
}

bool memory_is_low() {
  const Memory m = memory_of_machine();
  return double(m.available) < kMinimumMemory * double(m.total);
}

/// Selects the frames of a camera that are kept.
class FrameSelection {
 public:
  explicit FrameSelection(const CaptureJob& job) : job_(job) {}
  /// Whether to keep frame number `taken`, counted from 1, at `t` s after the first.
  bool keeps(std::uint64_t taken, double t) {
    if (!(job_.every > 0)) return (taken - 1) % job_.one_of == 0;
    // 1 us for rounding: due times are sums.
    if (!(t >= due_ - 1e-6)) return false;
    while (due_ <= t + 1e-6) due_ += job_.every;
    return true;
  }

 private:
  const CaptureJob& job_;
  double due_ = 0;  // s
};

void report_progress(const CaptureJob& job, const Captured& result) {
  if (!job.progress) return;
  if (job.frames > 0)
    job.progress(result.taken, job.frames);
  else
    job.progress(std::uint64_t(1e3 * result.duration), std::uint64_t(1e3 * job.time));
}

}  // namespace

std::string capture_format(const std::filesystem::path& out) {
  if (tiff_kind(out)) return "tif";
  const std::string extension = out.extension().string();
  return extension == ".mp4" ? "mp4" : extension == ".avi" ? "avi" : "";
}

Captured capture(const std::shared_ptr<Camera>& camera, const CaptureJob& job) {
  const std::unique_ptr<Store> store = store_for(job, *camera);
  CameraFeed feed(camera, camera->waits() ? CameraFeed::Keep::each : CameraFeed::Keep::all,
                  job.buffered ? SIZE_MAX : kBacklog,
                  job.only_corrupt ? CameraFeed::Which::all : CameraFeed::Which::good);
  Captured result;
  std::vector<CameraFrame> waiting;
  FrameSelection selection(job);
  double began = 0, last_frame_time = monotonic_now();
  const auto stopped = [&] { return job.stop && job.stop->load(); };
  const auto keep = [&](CameraFrame&& f) {
    ++result.kept;
    if (job.buffered)
      waiting.push_back(std::move(f));
    else
      store->put(f, f.t - began);
  };
  std::optional<Error> failure;
  try {
    while (!stopped()) {
      CameraFrame f;
      const CameraFeed::Got got = feed.next(f, monotonic_now() + kStopPollPeriod);
      if (got == CameraFeed::Got::end) break;
      if (got == CameraFeed::Got::nothing) {
        if (monotonic_now() - last_frame_time > job.timeout)
          throw Error(Errc::device, "camera",
                      fmt::format("no picture for {:g} s; check the camera and its cable", job.timeout));
        continue;
      }
      last_frame_time = monotonic_now();
      if (result.taken == 0) began = f.t;
      const double t = f.t - began;
      if (job.time > 0 && t >= job.time) break;
      ++result.taken;
      result.duration = t;
      if (f.corrupt == job.only_corrupt && selection.keeps(result.taken, t)) keep(std::move(f));
      result.dropped = feed.dropped();
      result.corrupt = feed.corrupt();
      result.buffered = waiting.size();
      report_progress(job, result);
      if (job.live) job.live(result);
      if (job.frames > 0 && result.taken >= job.frames) break;
      if (job.buffered && result.taken % kMemoryEvery == 0 && memory_is_low()) {
        result.memory_full = true;
        break;
      }
    }
  } catch (const Error& e) {
    failure = e;
  }
  result.dropped = feed.dropped();
  result.corrupt = feed.corrupt();
  for (CameraFrame& f : waiting) {
    store->put(f, f.t - began);
    f.image.reset();
  }
  if (failure && store->size() > 0)
    throw Error(failure->code(), failure->where(), store->kept_frames(*failure));
  store->finish();
  if (failure) throw Error(*failure);
  return result;
}

}  // namespace faba
