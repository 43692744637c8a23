#include <dlfcn.h>
#include <fmt/format.h>

#include "core/process/installation.h"
#include "rig/capture.h"

namespace faba {
namespace {

/// Cameras and streams that OpenCV's VideoCapture opens: V4L2, FireWire, GStreamer pipelines, network. The
/// library takes 0.1 s to load; therefore it is in a separate module that only this camera loads.
class OpenCvCamera final : public Camera {
 public:
  using Params = CaptureParams;
  static Schema<Params> schema() {
    return Schema<Params>("opencv", "A camera that OpenCV opens: V4L2, FireWire, GStreamer, network")
        .add("device", &Params::device,
             {.doc = "Index of the camera (\"0\"), a path such as \"/dev/video0\", a URL, or a "
                     "GStreamer pipeline"})
        .add("interface", &Params::interface,
             {.doc = "Capture backend of OpenCV; any: chosen by OpenCV",
              .choices = {"any", "v4l2", "firewire", "gstreamer", "ffmpeg"}})
        .add("width", &Params::width,
             {.unit = "px", .min = 0, .max = 65535, .doc = "Requested image width; 0: camera default"})
        .add("height", &Params::height,
             {.unit = "px", .min = 0, .max = 65535, .doc = "Requested image height; 0: camera default"})
        .add("rate", &Params::rate,
             {.unit = "Hz", .min = 0, .max = 1e5, .doc = "Requested frame rate; 0: camera default"})
        .add("exposure", &Params::exposure,
             {.min = -1e6, .max = 1e9, .doc = "Exposure in the unit of the camera; default: unchanged"})
        .add("gain", &Params::gain,
             {.min = -1e6, .max = 1e9, .doc = "Gain in the unit of the camera; default: unchanged"})
        .add("white_balance", &Params::white_balance,
             {.unit = "K", .min = 0, .max = 1e5, .doc = "Colour temperature; default: unchanged"})
        .validity(
            "Time stamps come from the driver if it uses the monotonic clock (V4L2); otherwise they are "
            "arrival times. The driver was tested with videos in place of a camera, not on hardware.");
  }
  OpenCvCamera(const Params& p, const CameraContext&) : camera_(load()(p)) {}

  bool read(CameraFrame& out) override { return camera_->read(out); }
  void interrupt() noexcept override { camera_->interrupt(); }
  int width() const override { return camera_->width(); }
  int height() const override { return camera_->height(); }
  double rate() const override { return camera_->rate(); }
  std::uint64_t corrupt() const override { return camera_->corrupt(); }
  std::vector<CameraControl> controls() override { return camera_->controls(); }
  void set(const CameraControl& c) override { camera_->set(c); }

 private:
  static OpenCapture* load() {
    const std::string module = program_file("faba-capture.so").string();
    void* library = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(Errc::device, "opencv", fmt::format("cannot load {}: {}", module, dlerror()));
    auto* open = reinterpret_cast<OpenCapture*>(dlsym(library, "faba_open_capture"));
    if (!open)
      throw Error(Errc::device, "opencv",
                  fmt::format("{} comes from another version of Faba; reinstall it", module));
    return open;
  }
  std::unique_ptr<Camera> camera_;
};

}  // namespace

void add_opencv(CameraRegistry& r) { r.add<OpenCvCamera>(); }

}  // namespace faba
