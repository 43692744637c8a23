#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace faba {

/// A device that can be used in [rig].
struct Device {
  std::string kind;  ///< "camera", "serial line", "output device" or "USB device"
  std::string name;  ///< as written in [rig]
  std::string what;  ///< description given by the device; may be empty
};

/// Devices of this machine: V4L2 and FireWire cameras, serial lines, and National Instruments devices if
/// their library is installed; else those on the USB, with the library that drives them. Opens none of them.
/// `sys`: the folder in which the kernel describes devices.
std::vector<Device> device_list(const std::string& ni_library = "libnidaqmx.so.1",
                                const std::filesystem::path& sys = "/sys");

}  // namespace faba
