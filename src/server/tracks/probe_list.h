#pragma once
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "study/tracks/track_probe.h"

namespace faba {

/// The videos in which pages detect cells, each with its sampled frames in memory: the last three. A video is
/// surveyed in a thread of its own. Thread-safe.
class ProbeList {
 public:
  struct State {
    std::shared_ptr<TrackProbe> probe;  ///< null until the video is surveyed
    std::int64_t done = 0, of = 0;      ///< sampled frames
  };

  ProbeList() = default;
  ~ProbeList();

  /// Starts the survey if the video, its part or region is new, and waits a short time for its end. Throws
  /// its error.
  State get(const TrackOptions& options);

 private:
  struct Survey {
    std::string key;
    State state;
    std::exception_ptr error;
    std::jthread thread;
  };
  std::shared_ptr<Survey> begin(const std::string& key, const TrackOptions& options);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<std::shared_ptr<Survey>> surveys_;  ///< the most recently used one first
};

}  // namespace faba
