#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "rig/bench/bench_socket.h"
#include "rig/camera.h"
#include "vision/image/image.h"

namespace faba {
namespace {

/// The camera of a simulated bench (`faba rig simulate`), in a separate process.
class SimulatedCamera final : public Camera {
 public:
  struct Params {
    std::string at;
  };
  static constexpr std::array kTraits = {Trait::simulated};
  static Schema<Params> schema() {
    return Schema<Params>("simulated",
                          "The microscope of a simulated bench, in a separate process and in real time")
        .add("at", &Params::at,
             {.doc =
                  "Socket of the bench, as given to `faba rig simulate --at`; default: a bench that the run "
                  "starts"});
  }
  SimulatedCamera(const Params& p, const CameraContext&)
      : at_(p.at), socket_(BenchSocket::connect(at_, BenchHello::Role::camera)) {
    if (socket_.read(&next_, sizeof next_, kFrameTimeout) != BenchSocket::Got::all)
      throw Error(Errc::device, at_,
                  "the simulated bench sends no frames; another program may use its camera");
  }

  bool read(CameraFrame& out) override {
    if (!have_header_) {
      BenchSocket::Got got = BenchSocket::Got::nothing;
      while (got == BenchSocket::Got::nothing && !interrupted_)
        got = socket_.read(&next_, sizeof next_, kPollPeriod);
      if (got != BenchSocket::Got::all) return disconnected();
    }
    have_header_ = false;
    auto image = std::make_shared<Gray8>(next_.width, next_.height);
    if (socket_.read(image->px.data(), image->px.size(), kFrameTimeout) != BenchSocket::Got::all)
      return disconnected();
    if (const double gain = gain_; gain != 1)
      for (std::uint8_t& g : image->px) g = std::uint8_t(std::min(255.0, gain * g + 0.5));
    out.number = next_.number;
    out.t = next_.t;
    out.image = std::move(image);
    out.corrupt = next_.corrupt != 0;
    return true;
  }
  void interrupt() noexcept override { interrupted_ = true; }
  int width() const override { return next_.width; }
  int height() const override { return next_.height; }
  double rate() const override { return next_.rate; }
  std::vector<CameraControl> controls() override { return {{ControlKind::gain, gain_, {}}}; }
  void set(const CameraControl& c) override {
    if (c.kind != ControlKind::gain) return Camera::set(c);
    if (!(c.value >= kLeastGain && c.value <= kMostGain))
      throw Error(Errc::usage, control_name(c.kind),
                  fmt::format("{:g} is out of range; it must be between 0.1 and 10", c.value));
    gain_ = c.value;
  }

 private:
  static constexpr double kFrameTimeout = 10, kPollPeriod = 0.1;  // s
  static constexpr double kLeastGain = 0.1, kMostGain = 10;

  bool disconnected() const {
    if (interrupted_) return false;
    throw Error(Errc::device, at_, "simulated bench disconnected");
  }

  std::string at_;
  BenchSocket socket_;
  BenchFrame next_;
  bool have_header_ = true;
  std::atomic<bool> interrupted_ = false;
  std::atomic<double> gain_ = 1;  ///< applied to the 8-bit grey values
};

}  // namespace

void add_simulated_camera(CameraRegistry& r) { r.add<SimulatedCamera>(); }

}  // namespace faba
