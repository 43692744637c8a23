#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/monotonic.h"
#include "rig/camera.h"
#include "vision/files/grey_video.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

/// A video, a TIFF stack or a folder of images in place of a camera, played in real time.
class Playback final : public Camera {
 public:
  struct Params {
    std::string file;
    double fps = 0;
    bool fast = false;
  };
  static Schema<Params> schema() {
    return Schema<Params>("playback", "A video or a folder of images, played as a camera")
        .add("file", &Params::file, {.doc = "Video, TIFF stack, folder of images, or file name pattern"})
        .add("fps", &Params::fps, {.unit = "Hz", .min = 0, .max = 1e5, .doc = "Frame rate; 0: from the file"})
        .add("fast", &Params::fast,
             {.doc = "true: as fast as frames are processed, without skipping; false: in real time"})
        .validity("In real time, late frames are skipped, as with a camera.");
  }
  static void settle(Params& p, const Node& n) {
    if (p.file.empty()) n.fail("needs file = \"...\", the video to play");
    p.file = std::filesystem::absolute(n.file(p.file)).lexically_normal().string();
  }
  Playback(const Params& p, const CameraContext&) : p_(p), video_(p.file, p.fps) {
    if (!(video_.reader().fps() > 0))
      throw Error(Errc::input, p.file, "the file has no frame rate; set it with fps");
  }

  bool read(CameraFrame& out) override {
    double t = 0;
    do {
      if (interrupted_ || !video_.read(grey_, t)) return false;
      if (began_ == 0) began_ = monotonic_now() - t;
      out.number = ++number_;
      out.t = began_ + t;
    } while (!p_.fast && monotonic_now() > out.t + 1 / rate());
    out.image = std::make_shared<Gray8>(rounded(grey_));
    while (!p_.fast && !interrupted_) {
      const double left = out.t - monotonic_now();
      if (left <= 0) break;
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, 0.1)));
    }
    return true;
  }
  void interrupt() noexcept override { interrupted_ = true; }
  int width() const override { return video_.width(); }
  int height() const override { return video_.height(); }
  double rate() const override { return video_.reader().fps(); }
  bool waits() const override { return p_.fast; }
  std::uint64_t corrupt() const override { return std::uint64_t(video_.reader().damaged_frames()); }

 private:
  Params p_;
  GreyVideo video_;
  GrayF grey_;
  double began_ = 0;          ///< s, of the first frame
  std::uint64_t number_ = 0;  // the first frame is 1
  std::atomic<bool> interrupted_ = false;
};

}  // namespace

void add_playback(CameraRegistry& r) { r.add<Playback>(); }

}  // namespace faba
