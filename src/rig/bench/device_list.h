#pragma once
#include <string>
#include <vector>

namespace faba {

/// A device that can be used in [rig].
struct Device {
  std::string kind;  ///< "camera", "serial line" or "output device"
  std::string name;  ///< as written in [rig]
  std::string what;  ///< description given by the device; may be empty
};

/// Devices of this machine: V4L2 and FireWire cameras, serial lines, and National Instruments devices if
/// their library is installed. Opens none of them.
std::vector<Device> device_list(const std::string& ni_library = "libnidaqmx.so.1");

}  // namespace faba
