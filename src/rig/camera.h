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

/// One picture of a camera.
struct CameraFrame {
  std::uint64_t number = 0;  ///< counts what the camera took; gaps are frames that were lost on the way
  double t = 0;              ///< s, mid-exposure, on the clock of monotonic_now()
  ImageRef image;
};

/// What can be set at a camera while it works.
enum class ControlKind : std::size_t { exposure, gain, white_balance };

/// The names of camera controls in scenarios, messages and JSON, in the order of the enum.
inline constexpr std::array kControlNames = {"exposure", "gain", "white_balance"};

inline const char* control_name(ControlKind k) { return kControlNames.at(std::size_t(k)); }

/// None when no camera control has that name.
inline std::optional<ControlKind> control_kind(std::string_view name) {
  for (std::size_t i = 0; i < kControlNames.size(); ++i)
    if (name == kControlNames.at(i)) return ControlKind(i);
  return {};
}

/// A camera control and its value.
struct CameraControl {
  ControlKind kind = ControlKind::exposure;
  double value = 0;                   ///< in the camera's own unit
  std::optional<bool> automatically;  ///< the camera sets it by itself; none when it cannot
};

/// The error for a control that a camera does not have.
[[noreturn]] inline void refuse_control(const std::string& name) {
  throw Error(Errc::usage, name, "cannot be set at this camera");
}

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
  /// Throws Error(usage), with the control's name, for what the camera does not have or will not take.
  virtual void set(const CameraControl& c) { refuse_control(control_name(c.kind)); }
};

/// What a camera is made for.
struct CameraContext {};
using CameraRegistry = Registry<Camera, CameraContext>;

}  // namespace faba
