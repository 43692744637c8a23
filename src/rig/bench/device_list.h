#pragma once
#include <string>
#include <vector>

namespace faba {

/// Something that a [rig] can name.
struct Device {
  std::string kind;  ///< "camera", "serial line" or "output device"
  std::string name;  ///< as [rig] wants it
  std::string what;  ///< what it says of itself; may be empty
};

/// What this machine has: V4L2 and FireWire cameras, serial lines, and National Instruments devices where
/// their library is installed. Opens none of them.
std::vector<Device> device_list(const std::string& ni_library = "libnidaqmx.so.1");

}  // namespace faba
