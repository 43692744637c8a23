#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "rig/camera.h"

namespace faba {

/// Reads a camera in a separate thread, so that the consumer of the frames waits at most until its own
/// timeout, and counts dropped frames. If the device hangs, its thread is detached.
class CameraFeed {
 public:
  enum class Keep {
    newest,  ///< only the newest frame is kept; a late consumer misses frames: for control
    all,     ///< frames are queued in memory, at most `most` of them: for recording
    each     ///< the camera waits until its frame was taken: for sources that can wait, such as a video
  };
  enum class Which { good, all };  ///< whether next() returns damaged frames, too
  enum class Got { frame, nothing, end };

  CameraFeed(std::shared_ptr<Camera> camera, Keep keep, std::size_t most = SIZE_MAX,
             Which which = Which::good);
  ~CameraFeed();
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  /// The next frame; waits until time `until` (monotonic_now()). Rethrows the exception of the camera.
  Got next(CameraFrame& out, double until);
  /// Discards all frames taken before now, queued or on their way.
  void forget();
  std::uint64_t taken() const;    ///< frames returned by next()
  double behind() const;          ///< s, age of the last frame discarded because of forget(); 0: none was
  std::uint64_t dropped() const;  ///< frames of the camera that were lost or came too fast for next()
  std::uint64_t corrupt() const;  ///< damaged frames of the camera so far
  Camera& camera() { return *camera_; }

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<CameraFrame> waiting;
    std::uint64_t lost = 0, taken = 0, corrupt = 0;
    double since = 0;   ///< monotonic_now(): frames before this time are discarded
    double behind = 0;  ///< s
    std::exception_ptr failure;
    bool end = false, stop = false, exited = false;
  };
  static void read_frames(const std::shared_ptr<Camera>& camera, const std::shared_ptr<Shared>& s, Keep keep,
                          std::size_t most, Which which);

  std::shared_ptr<Camera> camera_;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace faba
