#include "app/bench/viewed_bench.h"

#include "app/scenario/read_scenario.h"
#include "rig/bench/camera_feed.h"

namespace faba {
namespace {

constexpr double kPollPeriod = 0.1;  // s

}  // namespace

ViewedBench::ViewedBench(const Document& scene, std::string name)
    : scene_(scene),
      name_(std::move(name)),
      scenario_(read_scenario(scene, builtin_parts())),
      device_(std::make_shared<OpenCamera>()) {
  if (scenario_.rig && scenario_.rig->needs_bench())
    simulated_ = std::make_shared<BenchProcess>(scenario_, seed());
  device_->camera =
      OpenBench(scenario_, seed(), OpenBench::Open::all, {simulated_, nullptr, nullptr}).camera();
  live_ = std::make_shared<LivePicture>(scenario_);
  device_->seen = [live = live_](const CameraFrame& f) { live->take(f); };
}

ViewedBench::~ViewedBench() {
  device_->camera->interrupt();  // a camera that hangs must not delay the end
  stop_view();
}

void ViewedBench::view() {
  if (viewer_.joinable()) return;
  live_->resume();
  {
    const std::lock_guard lock(mutex_);
    trouble_.clear();
  }
  viewer_ = std::jthread([this](const std::stop_token& stop) { read_camera(stop); });
}

void ViewedBench::stop_view() {
  viewer_ = {};
  live_->resume();
}

void ViewedBench::read_camera(const std::stop_token& stop) {
  std::string trouble;
  try {
    CameraFeed feed(camera(), CameraFeed::Keep::newest);
    while (!stop.stop_requested()) {
      CameraFrame f;
      if (feed.next(f, monotonic_now() + kPollPeriod) == CameraFeed::Got::end && !stop.stop_requested()) {
        trouble = "camera: no more pictures; this is the last one";
        break;
      }
    }
  } catch (const Error& e) {
    trouble = e.what();
  }
  const std::lock_guard lock(mutex_);
  trouble_ = trouble;
}

void ViewedBench::describe(Json& j, bool all) const {
  j["open"] = name_;
  if (all) live_->describe(j);
  {
    const std::lock_guard lock(mutex_);
    if (!trouble_.empty()) j["trouble"] = trouble_;
  }
  if (!all) return;
  Camera& camera = *device_->camera;
  j["size_px"] = {camera.width(), camera.height()};
  j["um_per_px"] = scenario_.scale.um_per_px ? Json(*scenario_.scale.um_per_px) : Json();
  Json controls = Json::array();
  for (const CameraControl& c : camera.controls())
    controls.push_back({{"name", control_name(c.kind)},
                        {"value", c.value},
                        {"automatically", c.automatically ? Json(*c.automatically) : Json()}});
  j["controls"] = std::move(controls);
  const Outline edge = scenario_.arena.make({scenario_.si_scale()})->outline();
  j["outline"] = edge.radius_px > 0 ? Json{{"centre_px", {edge.centre_image.x, edge.centre_image.y}},
                                           {"radius_px", edge.radius_px}}
                                    : Json();
  Json coils = Json::array();
  for (const double most : permitted_currents(scenario_))
    coils.push_back({{"current_a", 0.0}, {"sensed_a", nullptr}, {"max_a", most}});
  if (j["coils"].empty()) j["coils"] = std::move(coils);
}

}  // namespace faba
