#include <dlfcn.h>
#include <fmt/format.h>

#include <map>

#include "rig/coil_driver.h"

namespace faba {
namespace {

// Types and constants of the NI-DAQmx C interface (NI-DAQmx C Reference Help).
using Task = void*;
constexpr std::int32_t kVolts = 10348;         // DAQmx_Val_Volts
constexpr std::int32_t kDefaultTerminal = -1;  // DAQmx_Val_Cfg_Default
constexpr std::int32_t kAllLines = 1;          // DAQmx_Val_ChanForAllLines
constexpr std::uint32_t kByChannel = 0;        // DAQmx_Val_GroupByChannel

constexpr const char* kLibrary = "libnidaqmx.so.1";
constexpr const char* kBaseLibrary =
    "libnidaqmxbase.so";  // supports devices that NI-DAQmx for Linux does not

/// The library, loaded at run time: the program does not link to it. NI-DAQmx, or NI-DAQmx Base, whose
/// functions have the prefix DAQmxBase, the same arguments, and no function for single digital lines.
class Daqmx {
 public:
  explicit Daqmx(const std::string& library) : library_(dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    const std::string reason = library_ ? "" : dlerror();
    if (!library_ && library == kLibrary) {
      dlopen("liblvrtdark.so",
             RTLD_NOW | RTLD_GLOBAL);  // NI-DAQmx Base needs its symbols, but does not load it
      library_ = dlopen(kBaseLibrary, RTLD_NOW | RTLD_LOCAL);
    }
    if (!library_)
      throw Error(
          Errc::device, "nidaqmx",
          fmt::format(
              "cannot load {} ({}); install NI-DAQmx for Linux, or NI-DAQmx Base for devices that it does "
              "not support, such as the USB-6009; or set the path of the library in rig.driver.library",
              library, reason));
    base_ = dlsym(library_, "DAQmxBaseCreateTask") != nullptr;
    find(create_task, "CreateTask");
    find(create_output, "CreateAOVoltageChan");
    find(create_input, "CreateAIVoltageChan");
    find(create_line, "CreateDOChan");
    find(start, "StartTask");
    find(clear, "ClearTask");
    find(write, "WriteAnalogF64");
    find(read, "ReadAnalogF64");
    find(write_line, base_ ? "WriteDigitalU8" : "WriteDigitalLines");
    find(error_text, "GetExtendedErrorInfo");
  }
  /// The value of a high line: one byte per line, or the bits of a port, of which only those of the task
  /// count.
  std::uint8_t high() const { return base_ ? 0xFF : 1; }
  // Never unloaded: the library runs its own threads.

  std::int32_t (*create_task)(const char*, Task*) = nullptr;
  std::int32_t (*create_output)(Task, const char*, const char*, double, double, std::int32_t,
                                const char*) = nullptr;
  std::int32_t (*create_input)(Task, const char*, const char*, std::int32_t, double, double, std::int32_t,
                               const char*) = nullptr;
  std::int32_t (*create_line)(Task, const char*, const char*, std::int32_t) = nullptr;
  std::int32_t (*start)(Task) = nullptr;
  std::int32_t (*clear)(Task) = nullptr;
  std::int32_t (*write)(Task, std::int32_t, std::uint32_t, double, std::uint32_t, const double*,
                        std::int32_t*, std::uint32_t*) = nullptr;
  std::int32_t (*read)(Task, std::int32_t, double, std::uint32_t, double*, std::uint32_t, std::int32_t*,
                       std::uint32_t*) = nullptr;
  std::int32_t (*write_line)(Task, std::int32_t, std::uint32_t, double, std::uint32_t, const std::uint8_t*,
                             std::int32_t*, std::uint32_t*) = nullptr;

  /// Error text of the last call that failed in this thread.
  std::string error(std::int32_t code) const {
    std::string text(2048, '\0');
    if (error_text(text.data(), std::uint32_t(text.size())) < 0) text.clear();
    text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
    for (char& c : text)
      if (c == '\n' || c == '\r') c = ' ';
    return fmt::format("NI-DAQmx {}: {}", code, text);
  }

 private:
  template <class Function>
  void find(Function& f, const char* name) {
    const std::string full = (base_ ? "DAQmxBase" : "DAQmx") + std::string(name);
    f = reinterpret_cast<Function>(dlsym(library_, full.c_str()));
    if (!f) throw Error(Errc::device, "nidaqmx", fmt::format("the library has no function {}", full));
  }
  std::int32_t (*error_text)(char*, std::uint32_t) = nullptr;
  void* library_;
  bool base_ = false;
};

/// Analogue outputs of National Instruments devices, such as the thesis's USB-6009 (two outputs of 0 to 5 V,
/// 12 bits, timed by software): one task for each device that the channels name.
class NiDaqmx final : public CoilDriver {
 public:
  struct Params {
    std::string library = kLibrary;
    std::string enable_line;
    double timeout = 0.05;
  };
  static Schema<Params> schema() {
    return Schema<Params>("nidaqmx",
                          "National Instruments devices, through the NI-DAQmx library if installed")
        .add("library", &Params::library,
             {.doc = "Name or path of the library: NI-DAQmx, or NI-DAQmx Base, which is also loaded if the "
                     "default is not "
                     "installed"})
        .add("enable_line", &Params::enable_line,
             {.doc = "Digital line such as \"Dev1/port0/line0\" that toggles while the guard runs; the "
                     "electronics must permit current only while it toggles"})
        .add("timeout", &Params::timeout,
             {.unit = "s",
              .min = 1e-3,
              .max = 1,
              .doc = "Timeout of a call to the device; a longer call is a device error"})
        .validity(
            "Channels have NI names: outputs \"Dev1/ao0\", inputs \"Dev1/ai0\". The driver "
            "was tested with mocks of both libraries, not on hardware. NI-DAQmx for Linux does not support "
            "the USB-6008 and USB-6009; NI-DAQmx Base was made for such devices. A USB-6009 keeps its last "
            "voltage if "
            "the computer fails and has no watchdog: without an enable line the guard does not arm.");
  }
  NiDaqmx(const Params& p, const DriverContext& c) : p_(p), ni_(p.library) {
    for (std::size_t i = 0; i < c.channels.size(); ++i) {
      Group& g = group(outputs_, c.channels[i]);
      g.index.push_back(i);
      check(ni_.create_output(g.task, c.channels[i].c_str(), "", c.least_volts[i], c.most_volts[i], kVolts,
                              nullptr));
    }
    for (std::size_t i = 0; i < c.senses.size(); ++i) {
      Group& g = group(inputs_, c.senses[i]);
      g.index.push_back(i);
      check(ni_.create_input(g.task, c.senses[i].c_str(), "", kDefaultTerminal, -10, 10, kVolts, nullptr));
    }
    if (!p.enable_line.empty()) {
      check(ni_.create_task("", &line_));
      check(ni_.create_line(line_, p.enable_line.c_str(), "", kAllLines));
      check(ni_.start(line_));
    }
    for (auto* groups : {&outputs_, &inputs_})
      for (auto& [device, g] : *groups) check(ni_.start(g.task));
    if (const Status s = write(c.neutral, false); !s) throw Error(Errc::device, "nidaqmx", s.error);
  }
  ~NiDaqmx() override {
    for (auto* groups : {&outputs_, &inputs_})
      for (auto& [device, g] : *groups) ni_.clear(g.task);
    if (line_) ni_.clear(line_);
  }

  Status write(std::span<const double> volts, bool enable) override {
    Status status;
    const auto check_call = [&](std::int32_t code) {
      if (code < 0 && status) status.error = ni_.error(code);
    };
    if (line_) {  // first, so that the current is cut off even if writing the outputs fails
      high_ = enable && !high_;
      const std::uint8_t level = high_ ? ni_.high() : 0;
      check_call(ni_.write_line(line_, 1, 0, p_.timeout, kByChannel, &level, nullptr, nullptr));
    }
    for (auto& [device, g] : outputs_) {
      for (std::size_t i = 0; i < g.index.size(); ++i) g.volts[i] = volts[g.index[i]];
      check_call(ni_.write(g.task, 1, 0, p_.timeout, kByChannel, g.volts.data(), nullptr, nullptr));
    }
    return status;
  }
  Status sense(std::span<double> volts) override {
    for (auto& [device, g] : inputs_) {
      std::int32_t got = 0;
      const std::int32_t code = ni_.read(g.task, 1, p_.timeout, kByChannel, g.volts.data(),
                                         std::uint32_t(g.volts.size()), &got, nullptr);
      if (code < 0) return {ni_.error(code)};
      for (std::size_t i = 0; i < g.index.size(); ++i) volts[g.index[i]] = g.volts[i];
    }
    return {};
  }
  std::string unsafe() const override {
    if (line_) return "";
    return "no enable line: the device keeps its last voltage if this computer fails; set "
           "rig.driver.enable_line to a digital line, and permit current only while it toggles";
  }

 private:
  struct Group {
    Task task = nullptr;
    std::vector<std::size_t> index;  ///< of the channels
    std::vector<double> volts;
  };
  void check(std::int32_t code) const {
    if (code < 0) throw Error(Errc::device, "nidaqmx", ni_.error(code));
  }
  Group& group(std::map<std::string, Group>& groups, const std::string& channel) const {
    Group& g = groups[channel.substr(0, channel.find('/'))];
    if (!g.task) check(ni_.create_task("", &g.task));
    g.volts.push_back(0);
    return g;
  }

  Params p_;
  Daqmx ni_;
  std::map<std::string, Group> outputs_,
      inputs_;  ///< by device: the channels of a task must belong to one device
  Task line_ = nullptr;
  bool high_ = false;
};

}  // namespace

void add_nidaqmx(CoilDriverRegistry& r) { r.add<NiDaqmx>(); }

}  // namespace faba
