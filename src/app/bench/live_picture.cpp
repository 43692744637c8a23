#include "app/bench/live_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/monotonic.h"
#include "vision/files/frame_encoder.h"

namespace faba {
namespace {

constexpr double kRateTime = 1;          // s, averaging time of the frame rate
constexpr double kPictureTimeout = 2;    // s without a picture, after which this is reported
constexpr double kEstimatePeriod = 0.1;  // s between two estimates: ten per second look continuous
constexpr double kMostSaturated = 0.02;  // of the pixels; in brighter pictures cells are not visible; assumed
constexpr std::size_t kBins = 64;        // of the histogram, each of 4 grey levels

double saturated(const Gray8& picture) {
  const auto white = std::count(picture.px.begin(), picture.px.end(), std::uint8_t(255));
  return double(white) / double(std::max<std::size_t>(1, picture.px.size()));
}

void add_little_endian(std::string& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to.push_back(char(value >> (8 * i) & 0xff));
}

// Windows bitmap with 8 bits per pixel and a grey palette: BITMAPFILEHEADER and BITMAPINFOHEADER of the
// Windows API. A negative height means that the first row is the upper one.
std::string bitmap(const Gray8& picture) {
  constexpr std::uint32_t kHeaders = 14 + 40, kPalette = 4 * 256;
  const auto width = std::uint32_t(picture.width), height = std::uint32_t(picture.height);
  const std::uint32_t row = (width + 3) / 4 * 4, pixels = row * height;  // rows are multiples of 4 bytes
  std::string out = "BM";
  out.reserve(kHeaders + kPalette + pixels);
  for (const std::uint32_t v :
       {kHeaders + kPalette + pixels, 0u, kHeaders + kPalette, 40u, width, 0u - height})
    add_little_endian(out, v, 4);
  add_little_endian(out, 1, 2);  // planes
  add_little_endian(out, 8, 2);  // bits per pixel
  for (const std::uint32_t v : {0u, pixels, 0u, 0u, 256u, 0u}) add_little_endian(out, v, 4);
  for (std::uint32_t g = 0; g < 256; ++g) add_little_endian(out, g * 0x010101u, 4);
  for (int y = 0; y < picture.height; ++y) {
    out.append(reinterpret_cast<const char*>(&picture.px[std::size_t(y) * width]), width);
    out.append(row - width, '\0');
  }
  return out;
}

}  // namespace

Json swarm_json(const Estimate& e, const Frame& frame) {
  if (!(e.visible > 0)) return nullptr;
  const Vec2 centre = frame.image_from_world(e.centroid);
  const double k = 1 / (frame.m_per_px * frame.m_per_px);
  // y is down in pictures: the covariance of x and y changes its sign.
  return {{"cells", e.visible},
          {"centroid_px", {centre.x, centre.y}},
          {"covariance_px2", {k * e.cov.xx, -k * e.cov.xy, k * e.cov.yy}}};
}

LivePicture::LivePicture(const Scenario& s)
    : received_(monotonic_now()),
      scenario_(s),
      estimator_([this](const std::stop_token& stop) { estimate_swarms(stop); }) {}

LivePicture::~LivePicture() = default;

void LivePicture::take(const CameraFrame& f) {
  const double now = monotonic_now();
  const std::lock_guard lock(mutex_);
  const double dt = f.t - newest_.t;
  if (newest_.image && dt > 0) {
    const double weight = std::min(1.0, dt / kRateTime);
    rate_ = rate_ == 0 ? 1 / dt : 1 / (1 / rate_ + weight * (dt - 1 / rate_));
  }
  ++frames_;
  if (f.corrupt) ++corrupt_;
  if (last_number_ > 0 && f.number > last_number_ + 1) dropped_ += f.number - last_number_ - 1;
  last_number_ = f.number;
  newest_ = f;
  received_ = now;
  lateness_ = std::max(lateness_, now - f.t);
  arrived_.notify_all();
}

void LivePicture::resume() {
  const std::lock_guard lock(mutex_);
  lateness_ = 0;
  last_number_ = 0;
}

double LivePicture::lateness() const {
  const std::lock_guard lock(mutex_);
  return lateness_;
}

void LivePicture::forget_brightness() {
  const std::lock_guard lock(mutex_);
  brightness_changed_ = true;
}

void LivePicture::estimate_swarms(const std::stop_token& stop) {
  auto controls = std::make_unique<BenchControls>(scenario_);
  std::uint64_t last = 0;
  double began = 0;
  while (!stop.stop_requested()) {
    Observation seen;
    {
      std::unique_lock lock(mutex_);
      if (!arrived_.wait(lock, stop, [&] { return newest_.image && newest_.number != last; })) return;
      last = newest_.number;
      if (newest_.corrupt) continue;
      if (began == 0) began = newest_.t;
      seen.frame = last;
      seen.t = newest_.t - began;
      seen.image = newest_.image;
      if (std::exchange(brightness_changed_, false)) controls = std::make_unique<BenchControls>(scenario_);
    }
    Json estimate;
    try {
      if (saturated(*seen.image) <= kMostSaturated)
        estimate = swarm_json(controls->estimator->update(seen, {}), controls->frame);
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a display without the estimate
    }
    {
      const std::lock_guard lock(mutex_);
      estimate_ = std::move(estimate);
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(kEstimatePeriod));
  }
}

void LivePicture::describe(Json& j) const {
  ImageRef image;
  {
    const std::lock_guard lock(mutex_);
    image = newest_.image;
    j["estimate"] = estimate_;
    j["frames"] = frames_;
    j["dropped"] = dropped_;
    j["corrupt"] = corrupt_;
    j["rate_hz"] = rate_ > 0 ? Json(rate_) : Json();
    const double silent = monotonic_now() - received_;
    if (silent > kPictureTimeout + (rate_ > 0 ? 2 / rate_ : 0)) {
      j["rate_hz"] = nullptr;
      j["trouble"] = fmt::format("camera: no picture for {:.0f} s", silent);
    }
  }
  if (!image || image->px.empty()) return;
  std::array<std::uint64_t, 256> levels{};
  for (const std::uint8_t g : image->px) ++levels[g];
  const auto pixels = double(image->px.size());
  double sum = 0;
  std::array<std::uint64_t, kBins> bins{};
  for (std::size_t g = 0; g < levels.size(); ++g) {
    sum += double(g) * double(levels[g]);
    bins[g * kBins / levels.size()] += levels[g];
  }
  j["mean"] = sum / pixels;
  j["saturated"] = double(levels.back()) / pixels;
  j["histogram"] = bins;
}

ImageRef LivePicture::image() const {
  const std::lock_guard lock(mutex_);
  return newest_.image;
}

std::string LivePicture::png() const {
  const ImageRef image = this->image();
  if (!image) return {};
  FrameEncoder png(FrameEncoder::Kind::png_grey, image->width, image->height);
  const auto bytes = png.encode(*image);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string LivePicture::bmp() const {
  const ImageRef image = this->image();
  return image ? bitmap(*image) : std::string();
}

}  // namespace faba
