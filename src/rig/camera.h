#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/registry.h"
#include "core/signals.h"

namespace faba {

/// One frame of a camera.
struct CameraFrame {
  std::uint64_t number = 0;  ///< counts frames taken by the camera; gaps are frames lost in transfer
  double t = 0;              ///< s, mid-exposure, on the clock of monotonic_now()
  ImageRef image;
  bool corrupt = false;  ///< arrived damaged: the picture is not valid
};

/// Camera controls that can be set during operation.
enum class ControlKind : std::size_t { exposure, gain, white_balance };

/// The names of camera controls in scenarios, messages and JSON, in the order of the enum.
inline constexpr std::array kControlNames = {"exposure", "gain", "white_balance"};

inline const char* control_name(ControlKind k) { return kControlNames.at(std::size_t(k)); }

/// Empty if no camera control has this name.
inline std::optional<ControlKind> control_kind(std::string_view name) {
  for (std::size_t i = 0; i < kControlNames.size(); ++i)
    if (name == kControlNames.at(i)) return ControlKind(i);
  return {};
}

/// A camera control and its value.
struct CameraControl {
  ControlKind kind = ControlKind::exposure;
  double value = 0;                   ///< in the unit of the camera
  std::optional<bool> automatically;  ///< automatic mode is on; empty if the camera has no automatic mode
};

/// The error for a control that a camera does not have.
[[noreturn]] inline void reject_control(const std::string& name) {
  throw Error(Errc::usage, name, "this camera has no such control");
}

/// A stream of frames of one size. After construction it is open and the first frame is available.
class Camera {
 public:
  virtual ~Camera() = default;
  /// Waits for the next frame. False at the end of the stream. Throws Error(device) if the camera fails.
  /// Called by one thread; all other functions may be called by other threads at the same time.
  virtual bool read(CameraFrame& out) = 0;
  /// Makes a waiting read() return false soon; not every device supports this.
  virtual void interrupt() noexcept = 0;
  virtual int width() const = 0;                ///< px
  virtual int height() const = 0;               ///< px
  virtual double rate() const = 0;              ///< Hz; 0 if unknown
  virtual bool waits() const { return false; }  ///< no frame is lost while none is read, as with a file
  /// Damaged frames so far of which no picture is left, so that read() skipped them.
  virtual std::uint64_t corrupt() const { return 0; }
  virtual std::vector<CameraControl> controls() { return {}; }
  /// Throws Error(usage), with the control's name, if the camera does not have the control or rejects the
  /// value.
  virtual void set(const CameraControl& c) { reject_control(control_name(c.kind)); }
};

/// Context for the construction of a camera.
struct CameraContext {};
using CameraRegistry = Registry<Camera, CameraContext>;

}  // namespace faba
