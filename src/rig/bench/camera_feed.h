#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "rig/camera.h"

namespace faba {

/// Reads a camera in a thread of its own, so that whoever takes the frames never waits longer than it wants
/// to, and counts what was lost. A device that hangs is left alone, thread and all.
class CameraFeed {
 public:
  enum class Keep {
    newest,  ///< who is late misses frames: for control
    all,     ///< frames wait in memory until they are taken, the oldest `most` of them: for recording
    each     ///< the camera waits until its frame was taken: for one that can, such as a video
  };
  enum class Got { frame, nothing, end };

  CameraFeed(std::shared_ptr<Camera> camera, Keep keep, std::size_t most = SIZE_MAX);
  ~CameraFeed();
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  /// The next frame, waiting for it until time `until` (monotonic_now()). Throws what the camera threw.
  Got next(CameraFrame& out, double until);
  /// The next frame is one that the camera takes from now on: what waits, here or on its way, was never
  /// taken.
  void forget();
  std::uint64_t taken() const;    ///< frames that next() gave
  double behind() const;          ///< s, how old the last frame was that came and was forgotten; 0: none was
  std::uint64_t dropped() const;  ///< that the camera took and next() never gave, as far as is known
  Camera& camera() { return *camera_; }

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable came;
    std::deque<CameraFrame> waiting;
    std::uint64_t lost = 0, taken = 0;
    double since = 0;   ///< monotonic_now(): frames of before are forgotten
    double behind = 0;  ///< s
    std::exception_ptr failure;
    bool end = false, stop = false, left = false;
  };
  static void work(const std::shared_ptr<Camera>& camera, const std::shared_ptr<Shared>& s, Keep keep,
                   std::size_t most);

  std::shared_ptr<Camera> camera_;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace faba
