#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rig/camera.h"

namespace faba {

/// Counts of a capture.
struct Captured {
  std::uint64_t taken = 0, kept = 0;
  std::uint64_t dropped = 0;   ///< frames of the camera that were not read in time
  std::uint64_t corrupt = 0;   ///< frames that arrived damaged; left out unless only they are kept
  std::uint64_t buffered = 0;  ///< frames in memory that wait to be written
  double duration = 0;         ///< from the first to the last frame, s
  bool memory_full = false;    ///< a buffered capture stopped because the memory was full
};

/// Which pictures of a camera are recorded, and how (Fig. 3.9 of the thesis).
struct CaptureJob {
  std::uint64_t frames = 0;   ///< maximum number of camera frames; 0: no limit
  double time = 0;            ///< maximum duration, s; 0: no limit
  std::uint64_t one_of = 1;   ///< one of this number of frames is kept
  double every = 0;           ///< time between kept frames, s; 0: not used
  bool buffered = false;      ///< pictures are kept in memory and written at the end
  bool only_corrupt = false;  ///< only frames that arrived damaged are kept, if the camera still gives them
  /// mp4 or avi: a video; tif: a TIFF stack, of which the metadata are selected by the name of `out` (see
  /// tiff_kind()); png, pgm, ppm or tiff: a folder of numbered pictures.
  std::string format = "avi";
  std::filesystem::path out;
  std::optional<double> um_per_px = {};  ///< scale, for a TIFF stack; empty: not known
  bool force = false;                    ///< replace an existing video; a folder must be empty
  double timeout = 2;                    ///< maximum time without a frame, s
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< total 0: until stopped
  std::function<void(const Captured&)> live;  ///< called after every frame with the counts so far
  const std::atomic<bool>* stop = nullptr;
};

/// The format of a capture into a single file, by its name; empty if it is the name of a folder of pictures.
std::string capture_format(const std::filesystem::path& out);

/// Captures until a limit is reached, the camera has no more frames, or `stop` is set. The times of the
/// frames are written to `out` + ".csv" for a video or stack and to times.csv for pictures. The recorded
/// frames are kept in any case. During the capture a video or stack has the name `out` + ".part", and a
/// folder of pictures has a file `incomplete`; both stay if the camera fails or a file cannot be written.
/// Throws Error(usage) for an unsuitable `out`, Error(device) if the camera fails or exceeds `timeout`,
/// Error(internal) for a full disk.
Captured capture(const std::shared_ptr<Camera>& camera, const CaptureJob& job);

}  // namespace faba
