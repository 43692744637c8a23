#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "rig/camera.h"

namespace faba {

/// A camera that stays open while its users change, such as a live view and then a recording.
struct OpenCamera {
  std::shared_ptr<Camera> camera;
  /// Called with every frame that a user reads, by the thread of that user.
  std::function<void(const CameraFrame&)> seen;
  std::mutex reading;
};

/// The camera for one of its users. The end of a user does not interrupt the camera itself; a frame for which
/// it still waits is lost.
class SharedCamera final : public Camera {
 public:
  explicit SharedCamera(std::shared_ptr<OpenCamera> open)
      : open_(std::move(open)), corrupt_before_(open_->camera->corrupt()) {}
  bool read(CameraFrame& out) override {
    const std::lock_guard lock(open_->reading);
    if (interrupted_ || !open_->camera->read(out) || interrupted_) return false;
    if (open_->seen) open_->seen(out);
    return true;
  }
  void interrupt() noexcept override { interrupted_ = true; }
  int width() const override { return open_->camera->width(); }
  int height() const override { return open_->camera->height(); }
  double rate() const override { return open_->camera->rate(); }
  bool waits() const override { return open_->camera->waits(); }
  std::uint64_t corrupt() const override { return open_->camera->corrupt() - corrupt_before_; }
  std::vector<CameraControl> controls() override { return open_->camera->controls(); }
  void set(const CameraControl& c) override { open_->camera->set(c); }

 private:
  std::shared_ptr<OpenCamera> open_;
  std::uint64_t corrupt_before_;
  std::atomic<bool> interrupted_ = false;
};

}  // namespace faba
