// faba-capture.so: see rig/drivers/opencv.cpp.
#include "rig/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "core/monotonic.h"
#include "vision/image/image.h"

namespace faba {
namespace {

constexpr double kPlausible = 1;  // s: an older time stamp comes from another clock

int backend(CaptureParams::Interface i) {
  using enum CaptureParams::Interface;
  switch (i) {
    case v4l2:
      return cv::CAP_V4L2;
    case firewire:
      return cv::CAP_FIREWIRE;
    case gstreamer:
      return cv::CAP_GSTREAMER;
    case ffmpeg:
      return cv::CAP_FFMPEG;
    case any:
      break;
  }
  return cv::CAP_ANY;
}

class Capture final : public Camera {
 public:
  explicit Capture(const CaptureParams& p) : name_(p.device) {
    // OpenCV's messages are suppressed; errors are thrown as Error.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    const bool number =
        !p.device.empty() && p.device.size() < 4 &&
        std::all_of(p.device.begin(), p.device.end(), [](char c) { return c >= '0' && c <= '9'; });
    const bool opened = number ? capture_.open(std::stoi(p.device), backend(p.interface))
                               : capture_.open(p.device, backend(p.interface));
    if (!opened)
      throw Error(Errc::device, fmt::format("camera \"{}\"", p.device),
                  "cannot open the camera; `faba rig list` lists the cameras of this machine");
    ask(cv::CAP_PROP_FRAME_WIDTH, p.width);
    ask(cv::CAP_PROP_FRAME_HEIGHT, p.height);
    ask(cv::CAP_PROP_FPS, p.rate);
    ask(cv::CAP_PROP_BUFFERSIZE, 1);
    for (const auto& [kind, value] :
         {std::pair{ControlKind::exposure, p.exposure}, std::pair{ControlKind::gain, p.gain},
          std::pair{ControlKind::white_balance, p.white_balance}})
      if (value) set({kind, *value, false});
    while (!pending_)
      if (!take()) throw Error(Errc::device, p.device, "the camera sends no frames");
  }

  bool read(CameraFrame& out) override {
    while (!pending_) {
      if (interrupted_ || !take()) return false;
    }
    pending_ = false;
    out.number = number_;
    out.t = t_;
    auto image = std::make_shared<Gray8>(grey_.cols, grey_.rows);
    for (int row = 0; row < grey_.rows; ++row)
      std::copy_n(grey_.ptr<std::uint8_t>(row), grey_.cols, &image->at(0, row));
    out.image = std::move(image);
    return true;
  }
  void interrupt() noexcept override { interrupted_ = true; }
  int width() const override { return grey_.cols; }
  int height() const override { return grey_.rows; }
  double rate() const override { return std::max(0.0, capture_.get(cv::CAP_PROP_FPS)); }
  std::uint64_t corrupt() const override { return corrupt_; }

  std::vector<CameraControl> controls() override {
    const auto automatic = [&](int property) -> std::optional<bool> {
      const double v = capture_.get(property);
      if (v <= 0 && property != cv::CAP_PROP_AUTO_WB) return {};
      return property == cv::CAP_PROP_AUTO_EXPOSURE ? std::fabs(v - kAutomaticExposure) < 0.5 : v > 0;
    };
    return {
        {ControlKind::exposure, capture_.get(cv::CAP_PROP_EXPOSURE), automatic(cv::CAP_PROP_AUTO_EXPOSURE)},
        {ControlKind::gain, capture_.get(cv::CAP_PROP_GAIN), {}},
        {ControlKind::white_balance, capture_.get(cv::CAP_PROP_WB_TEMPERATURE),
         automatic(cv::CAP_PROP_AUTO_WB)}};
  }
  void set(const CameraControl& c) override {
    if (!accepts(c))
      throw Error(Errc::usage, control_name(c.kind),
                  fmt::format("camera {} rejected the value {:g}", name_, c.value));
  }

 private:
  static constexpr double kAutomaticExposure = 3, kManualExposure = 1;  // values of V4L2

  bool accepts(const CameraControl& c) {
    const bool automatic = c.automatically.value_or(false);
    switch (c.kind) {
      case ControlKind::exposure: {
        const double mode = automatic ? kAutomaticExposure : kManualExposure;
        const bool switched = capture_.set(cv::CAP_PROP_AUTO_EXPOSURE, mode);
        return automatic ? switched : capture_.set(cv::CAP_PROP_EXPOSURE, c.value);
      }
      case ControlKind::gain:
        return capture_.set(cv::CAP_PROP_GAIN, c.value);
      case ControlKind::white_balance: {
        const bool switched = capture_.set(cv::CAP_PROP_AUTO_WB, automatic);
        return automatic ? switched : capture_.set(cv::CAP_PROP_WB_TEMPERATURE, c.value);
      }
    }
    return false;
  }
  void ask(int property, double value) {
    if (value > 0) capture_.set(property, value);
  }
  bool take() {
    if (!capture_.grab()) return false;
    const double now = monotonic_now(), stamp = 1e-3 * capture_.get(cv::CAP_PROP_POS_MSEC);
    if (!capture_.retrieve(colour_) || colour_.empty() || colour_.depth() != CV_8U) {
      ++corrupt_;
      ++number_;
      return !interrupted_;
    }
    if (colour_.channels() == 1)
      colour_.copyTo(grey_);
    else
      cv::cvtColor(colour_, grey_, cv::COLOR_BGR2GRAY);
    t_ = stamp > now - kPlausible && stamp <= now ? stamp : now;
    ++number_;
    pending_ = true;
    return true;
  }

  std::string name_;
  cv::VideoCapture capture_;
  cv::Mat colour_, grey_;
  double t_ = 0;
  std::uint64_t number_ = 0;
  std::atomic<std::uint64_t> corrupt_ = 0;
  bool pending_ = false;
  std::atomic<bool> interrupted_ = false;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) Camera* faba_open_capture(const CaptureParams& p);
Camera* faba_open_capture(const CaptureParams& p) { return std::make_unique<Capture>(p).release(); }

}  // namespace faba
