#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "rig/capture.h"

namespace faba {
namespace {

/// Whatever OpenCV's VideoCapture opens: V4L2 and FireWire cameras, GStreamer pipelines, network streams. The
/// library takes a tenth of a second to load, so that it is a module of its own that only this camera asks
/// for.
class OpenCvCamera final : public Camera {
 public:
  using Params = CaptureParams;
  static Schema<Params> schema() {
    return Schema<Params>("opencv", "A camera that OpenCV opens: V4L2, FireWire, GStreamer, network")
        .add("device", &Params::device,
             {.doc = "Number of the camera (\"0\"), a path such as \"/dev/video0\", an address, or a "
                     "GStreamer pipeline"})
        .add("interface", &Params::interface,
             {.doc = "How it is opened; any: as OpenCV finds best",
              .choices = {"any", "v4l2", "firewire", "gstreamer", "ffmpeg"}})
        .add("width", &Params::width,
             {.unit = "px", .min = 0, .max = 65535, .doc = "Asked of it; 0: its own"})
        .add("height", &Params::height,
             {.unit = "px", .min = 0, .max = 65535, .doc = "Asked of it; 0: its own"})
        .add("rate", &Params::rate, {.unit = "Hz", .min = 0, .max = 1e5, .doc = "Asked of it; 0: its own"})
        .add("exposure", &Params::exposure,
             {.min = -1e6, .max = 1e9, .doc = "In the camera's own unit; set by itself when absent"})
        .add("gain", &Params::gain,
             {.min = -1e6, .max = 1e9, .doc = "In the camera's own unit; set by itself when absent"})
        .add("white_balance", &Params::white_balance,
             {.unit = "K", .min = 0, .max = 1e5, .doc = "Colour temperature; set by itself when absent"})
        .validity(
            "Time stamps are the driver's where it gives them on the monotonic clock (V4L2), else the time "
            "when the "
            "frame arrived. Tried with videos in place of a camera, never with a camera.");
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
    std::error_code ec;
    const auto own = std::filesystem::read_symlink("/proc/self/exe", ec).parent_path();
    const std::string module = (own / "faba-capture.so").string();
    void* library = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library)
      throw Error(Errc::device, "opencv", fmt::format("{} cannot be loaded: {}", module, dlerror()));
    auto* open = reinterpret_cast<OpenCapture*>(dlsym(library, "faba_open_capture"));
    if (!open) throw Error(Errc::device, "opencv", fmt::format("{} is of another version", module));
    return open;
  }
  std::unique_ptr<Camera> camera_;
};

}  // namespace

void add_opencv(CameraRegistry& r) { r.add<OpenCvCamera>(); }

}  // namespace faba
