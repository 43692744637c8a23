#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "app/bench/live_picture.h"
#include "app/bench/open_bench.h"
#include "core/monotonic.h"
#include "rig/bench/shared_camera.h"

namespace faba {

/// The open bench of a scene: its camera stays open while a live view and recordings use it in turn. A
/// simulated bench keeps its swarm, as a real sample stays under the microscope.
class ViewedBench {
 public:
  /// Throws the errors of OpenBench. The view starts with view().
  ViewedBench(const Document& scene, std::string name);
  ~ViewedBench();
  ViewedBench(const ViewedBench&) = delete;
  ViewedBench& operator=(const ViewedBench&) = delete;

  /// Reads the camera for the display only, if it does not yet.
  void view();
  /// Leaves the camera to an activity.
  void stop_view();
  /// The camera for an activity, whose frames are displayed as well.
  std::shared_ptr<Camera> camera() const { return std::make_shared<SharedCamera>(device_); }
  BenchDevices devices(BenchWatcher* watcher) const { return {simulated_, camera(), watcher}; }
  /// Throws Error(usage) for a control or value that the camera does not support.
  void set(const CameraControl& c) {
    device_->camera->set(c);
    live_->forget_brightness();
  }
  /// Adds its members of the state for pages; `all`: also those for the page of the bench only.
  void describe(Json& j, bool all) const;

  const Document& scene() const { return scene_; }
  const Scenario& scenario() const { return scenario_; }
  std::uint64_t seed() const { return scenario_.params.seed.value_or(1); }
  LivePicture& live() { return *live_; }
  void mark_used() { last_used_ = monotonic_now(); }
  double last_used() const { return last_used_; }  ///< s

 private:
  void read_camera(const std::stop_token& stop);

  Document scene_;
  std::string name_;
  Scenario scenario_;
  std::shared_ptr<BenchProcess> simulated_;
  std::shared_ptr<OpenCamera> device_;
  std::shared_ptr<LivePicture> live_;  ///< shared with the thread of a camera that hangs
  std::atomic<double> last_used_ = monotonic_now();
  mutable std::mutex mutex_;  // protects trouble_
  std::string trouble_;
  std::jthread viewer_;
};

}  // namespace faba
