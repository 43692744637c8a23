#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "rig/camera.h"

namespace faba {

/// What is kept of a camera's pictures, and how (Fig. 3.9 of the thesis).
struct CaptureJob {
  std::uint64_t frames = 0;  ///< of the camera, after which it ends; 0: no such end
  double time = 0;           ///< s, after which it ends; 0: no such end
  std::uint64_t one_of = 1;  ///< of as many frames one is kept
  double every = 0;          ///< s between those that are kept; 0: all
  bool buffered = false;     ///< pictures wait in memory and are written afterwards
  /// mp4 or avi: a video; png, pgm, ppm or tiff: a folder of numbered pictures.
  std::string format = "avi";
  std::filesystem::path out;
  bool force = false;   ///< replace what is there; a folder must be empty
  double patience = 2;  ///< s that the camera may be silent
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< total 0: until stopped
  const std::atomic<bool>* stop = nullptr;
};

struct Captured {
  std::uint64_t taken = 0, kept = 0;
  std::uint64_t dropped = 0;  ///< that the camera took and nobody fetched in time
  std::uint64_t corrupt = 0;  ///< that came damaged and were left out
  double duration = 0;        ///< s from the first to the last
  bool memory_full = false;   ///< a buffered capture ended because memory went short
};

/// Captures until one of the ends is reached, the camera has no more, or somebody asks to stop. Beside a
/// video `out` the times of its frames are in `out` + ".csv", beside pictures in times.csv. What was captured
/// stays on every way out, of a video in `out` + ".part" when the camera failed. Throws Error(usage) for an
/// `out` that will not do, Error(device) when the camera fails or is silent for too long, Error(internal) for
/// a full disk.
Captured capture(const std::shared_ptr<Camera>& camera, const CaptureJob& job);

}  // namespace faba
