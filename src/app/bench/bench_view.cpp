#include "app/bench/bench_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "core/monotonic.h"
#include "rig/bench/camera_feed.h"
#include "vision/files/frame_encoder.h"

namespace faba {
namespace {

constexpr double kViewIdleTimeout = 20;    // s without a request, after which the camera is closed
constexpr double kViewPollPeriod = 0.1;    // s
constexpr double kViewPictureTimeout = 2;  // s without a picture, after which this is reported
constexpr double kViewRateTime = 1;        // s, averaging time of the frame rate

}  // namespace

// An open camera and the thread that reads its pictures.
struct BenchView::View {
  View(Scenario s, std::string what)
      : name(std::move(what)),
        bench(s, s.params.seed.value_or(1)),
        feed(bench.camera(), CameraFeed::Keep::newest) {
    fetcher = std::jthread([this](const std::stop_token& stop) { fetch(stop); });
  }
  void fetch(const std::stop_token& stop);
  void mark_used() { last_used = monotonic_now(); }

  std::string name;
  OpenBench bench;
  CameraFeed feed;
  std::atomic<double> last_used = monotonic_now();
  std::mutex mutex;  // protects the following members
  CameraFrame newest;
  double received = monotonic_now();  // s, time of arrival of `newest`
  double rate = 0;                    // Hz
  std::string trouble;
  std::jthread fetcher;
};

void BenchView::View::fetch(const std::stop_token& stop) {
  try {
    while (!stop.stop_requested()) {
      CameraFrame f;
      const CameraFeed::Got got = feed.next(f, monotonic_now() + kViewPollPeriod);
      if (got == CameraFeed::Got::end) {
        const std::lock_guard lock(mutex);
        trouble = "camera: no more pictures; this is the last one";
        return;
      }
      if (got == CameraFeed::Got::nothing) continue;
      const std::lock_guard lock(mutex);
      const double dt = f.t - newest.t;
      if (newest.image && dt > 0) {
        const double weight = std::min(1.0, dt / kViewRateTime);
        rate = rate == 0 ? 1 / dt : 1 / (1 / rate + weight * (dt - 1 / rate));
      }
      newest = std::move(f);
      received = monotonic_now();
    }
  } catch (const Error& e) {
    const std::lock_guard lock(mutex);
    trouble = e.what();
  }
}

BenchView::BenchView()
    : closer_([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          std::this_thread::sleep_for(std::chrono::duration<double>(kViewPollPeriod));
          const auto v = view(false);
          if (v && monotonic_now() - v->last_used > kViewIdleTimeout) close();
        }
      }) {}

BenchView::~BenchView() {
  closer_.request_stop();
  if (closer_.joinable()) closer_.join();
  close();
}

std::shared_ptr<BenchView::View> BenchView::view(bool required) {
  const std::lock_guard lock(mutex_);
  if (!view_ && required) throw Error(Errc::input, "bench", "no camera is open");
  return view_;
}

void BenchView::open(Scenario s, const std::string& name) {
  const std::lock_guard one_at_a_time(opening_);
  close();  // the new one may need the same camera
  const auto v = std::make_shared<View>(std::move(s), name);
  const std::lock_guard lock(mutex_);
  view_ = v;
}

void BenchView::close() {
  std::shared_ptr<View> v;
  {
    const std::lock_guard lock(mutex_);
    v.swap(view_);
  }
}

Json BenchView::state() {
  const auto v = view(false);
  if (!v) return {{"open", nullptr}};
  v->mark_used();
  Json controls = Json::array();
  for (const CameraControl& c : v->bench.camera()->controls())
    controls.push_back({{"name", control_name(c.kind)},
                        {"value", c.value},
                        {"automatically", c.automatically ? Json(*c.automatically) : Json()}});
  Json j = {{"open", v->name},
            {"size_px", {v->bench.camera()->width(), v->bench.camera()->height()}},
            {"frames", v->feed.taken()},
            {"dropped", v->feed.dropped()},
            {"corrupt", v->bench.camera()->corrupt()},
            {"controls", controls}};
  const std::lock_guard lock(v->mutex);
  j["rate_hz"] = v->rate > 0 ? Json(v->rate) : Json();
  if (!v->trouble.empty()) {
    j["trouble"] = v->trouble;
  } else if (const double silent = monotonic_now() - v->received;
             silent > kViewPictureTimeout + (v->rate > 0 ? 2 / v->rate : 0)) {
    j["trouble"] = fmt::format("camera: no picture for {:.0f} s", silent);
  }
  if (j.contains("trouble")) j["rate_hz"] = nullptr;
  if (v->newest.image && !v->newest.image->px.empty()) {
    const auto& px = v->newest.image->px;
    double sum = 0;
    for (const std::uint8_t g : px) sum += g;
    j["mean"] = sum / double(px.size());
    j["saturated"] = double(std::count(px.begin(), px.end(), std::uint8_t(255))) / double(px.size());
  }
  return j;
}

std::string BenchView::picture() {
  const auto v = view(false);
  if (!v) return {};
  v->mark_used();
  ImageRef image;
  {
    const std::lock_guard lock(v->mutex);
    image = v->newest.image;
  }
  if (!image) return {};
  FrameEncoder png(FrameEncoder::Kind::png_grey, image->width, image->height);
  const auto bytes = png.encode(*image);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void BenchView::set(const std::string& control, double value, std::optional<bool> automatically) {
  const auto v = view(true);
  const auto kind = control_kind(control);
  if (!kind) reject_control(control);
  v->bench.camera()->set({*kind, value, automatically});
}

}  // namespace faba
