#include "rig/bench/device_list.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace faba {
namespace {

namespace fs = std::filesystem;

// Sorted paths in a folder whose names start with `begin`.
std::vector<fs::path> entries(const fs::path& folder, const std::string& begin) {
  std::vector<fs::path> found;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, ec))
    if (e.path().filename().string().starts_with(begin)) found.push_back(e.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

void add_ni(std::vector<Device>& all, const std::string& library) {
  void* ni = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!ni) return;
  const auto names =
      reinterpret_cast<std::int32_t (*)(char*, std::uint32_t)>(dlsym(ni, "DAQmxGetSysDevNames"));
  const auto product = reinterpret_cast<std::int32_t (*)(const char*, char*, std::uint32_t)>(
      dlsym(ni, "DAQmxGetDevProductType"));
  std::string list(4096, '\0');
  if (!names || !product || names(list.data(), std::uint32_t(list.size())) < 0) return;
  list.resize(list.find('\0'));
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    const std::string name = list.substr(at, comma - at);
    std::string type(256, '\0');
    if (product(name.c_str(), type.data(), std::uint32_t(type.size())) < 0) type.assign(1, '\0');
    type.resize(type.find('\0'));
    all.push_back({"output device", name, type});
    at = list.find_first_not_of(", ", comma);
  }
}

// National Instruments devices on the USB. NI-DAQmx for Linux does not list those that it does not support.
void add_ni_usb(std::vector<Device>& all, const fs::path& sys) {
  for (const fs::path& device : entries(sys / "bus/usb/devices", "")) {
    if (first_line(device / "idVendor") != "3923") continue;
    const std::string product = first_line(device / "product");
    const bool listed = std::any_of(all.begin(), all.end(), [&](const Device& d) {
      return d.kind == "output device" && d.what == product;
    });
    if (listed) continue;
    const bool without_linux = product.find("USB-600") != std::string::npos;
    all.push_back(
        {"USB device", device.filename().string(),
         product + (without_linux
                        ? ": not supported by NI-DAQmx for Linux; use a serial board, or try NI-DAQmx Base"
                        : ": install NI-DAQmx, or NI-DAQmx Base if it does not support this device")});
  }
}

}  // namespace

std::vector<Device> device_list(const std::string& ni_library, const fs::path& sys) {
  std::vector<Device> all;
  for (const fs::path& video : entries(sys / "class/video4linux", "video"))
    all.push_back({"camera", "/dev/" + video.filename().string(), first_line(video / "name")});
  for (const fs::path& fw : entries(sys / "bus/firewire/devices", "fw"))
    if (fs::exists(fw / "model_name"))
      all.push_back({"camera", fw.filename().string(), first_line(fw / "model_name")});
  for (const char* kind : {"ttyACM", "ttyUSB"})
    for (const fs::path& line : entries("/dev", kind)) all.push_back({"serial line", line.string(), ""});
  for (const fs::path& line : entries("/dev/serial/by-id", ""))
    all.push_back({"serial line", line.string(), fs::read_symlink(line).filename().string()});
  add_ni(all, ni_library);
  add_ni_usb(all, sys);
  return all;
}

}  // namespace faba
