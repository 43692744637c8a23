#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/registry.h"
#include "core/signals.h"

namespace faba {

/// One picture of a camera.
struct CameraFrame {
  std::uint64_t number = 0;  ///< counts what the camera took; gaps are frames that were lost on the way
  double t = 0;              ///< s, mid-exposure, on the clock of monotonic_now()
  ImageRef image;
};

/// Something that can be set at a camera while it works, such as its exposure.
struct CameraControl {
  std::string name;                   ///< "exposure", "gain", "white_balance" ...
  double value = 0;                   ///< in the camera's own unit
  std::optional<bool> automatically;  ///< the camera sets it by itself; none when it cannot
};

/// A stream of pictures, all of one size. Made, it is open and its first picture known to be there.
class Camera {
 public:
  virtual ~Camera() = default;
  /// Waits for the next picture. False when there are no more. Throws Error(device) when the camera fails.
  /// Called by one thread, while others may call all else.
  virtual bool read(CameraFrame& out) = 0;
  /// Makes a read() that waits return soon, with false; may be beyond a device's power.
  virtual void interrupt() noexcept = 0;
  virtual int width() const = 0;                       ///< px
  virtual int height() const = 0;                      ///< px
  virtual double rate() const = 0;                     ///< Hz; 0 when it does not tell
  virtual bool waits() const { return false; }         ///< nothing is lost while nobody reads, as with a file
  virtual std::uint64_t corrupt() const { return 0; }  ///< frames so far that came damaged and were left out
  virtual std::vector<CameraControl> controls() { return {}; }
  /// Throws Error(usage, name) for what the camera does not have or will not take.
  virtual void set(const CameraControl& c) {
    throw Error(Errc::usage, c.name, "cannot be set at this camera");
  }
};

/// What a camera is made for.
struct CameraContext {};
using CameraRegistry = Registry<Camera, CameraContext>;

}  // namespace faba
