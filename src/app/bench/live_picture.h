#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "app/bench/bench_controls.h"
#include "rig/camera.h"

namespace faba {

/// "cells", "centroid_px" and "covariance_px2" of a swarm in a picture; null without cells.
Json swarm_json(const Estimate& e, const Frame& frame);

/// The newest frame of a camera for display: its rate, histogram and position of the swarm. The estimate is
/// that of the scene's estimator, for some of the frames, in a separate thread. Thread-safe.
class LivePicture {
 public:
  explicit LivePicture(const Scenario& s);
  ~LivePicture();

  /// Keeps the frame for the display; fast.
  void take(const CameraFrame& f);
  /// Another user reads the camera from now on: the numbers of its frames have a gap, and the lateness is
  /// measured again.
  void resume();
  /// The brightness of the pictures changes: the estimator starts again.
  void forget_brightness();
  double lateness() const;  ///< s, largest age of a frame on arrival
  /// Adds "frames", "dropped", "corrupt", "rate_hz", "mean", "saturated", "histogram" and "estimate" to `j`,
  /// and "trouble" if no frames arrive.
  void describe(Json& j) const;
  /// As PNG, or as BMP, which needs no time for compression; empty without a picture.
  std::string png() const;
  std::string bmp() const;

 private:
  ImageRef image() const;
  void estimate_swarms(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any arrived_;
  CameraFrame newest_;
  double received_;      ///< s, arrival of `newest_`
  double rate_ = 0;      ///< Hz
  double lateness_ = 0;  ///< s
  std::uint64_t frames_ = 0, dropped_ = 0, corrupt_ = 0;
  std::uint64_t last_number_ = 0;  ///< 0: the next frame follows a gap
  Json estimate_;
  const Scenario scenario_;
  bool brightness_changed_ = false;
  std::jthread estimator_;
};

}  // namespace faba
