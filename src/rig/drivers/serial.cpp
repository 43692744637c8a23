#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

#include "core/monotonic.h"
#include "rig/coil_driver.h"

namespace faba {
namespace {

// CRC-16 with polynomial 0x1021 and initial value 0xFFFF.
std::uint16_t crc16(std::string_view text) {
  std::uint16_t crc = 0xFFFF;
  for (const char byte : text) {
    crc = std::uint16_t(crc ^ std::uint16_t(std::uint8_t(byte)) << 8);
    for (int bit = 0; bit < 8; ++bit) crc = std::uint16_t(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
  }
  return crc;
}

struct Answer {
  std::uint32_t number = 0;
  int state = 0;
  std::vector<double> volts;
};

// "$A number state bad_lines v0 v1 ...*CRC", microvolts; empty if it is damaged.
std::optional<Answer> parse_answer(std::string_view line) {
  if (line.size() < 8 || line.front() != '$' || line[line.size() - 5] != '*') return {};
  const std::string_view body = line.substr(1, line.size() - 6), tail = line.substr(line.size() - 4);
  unsigned stated = 0;
  if (std::from_chars(tail.data(), tail.data() + 4, stated, 16).ptr != tail.data() + 4 ||
      stated != crc16(body))
    return {};
  if (!body.starts_with("A ")) return {};
  std::vector<std::int64_t> numbers;
  const char *at = body.data() + 2, *end = body.data() + body.size();
  while (at < end) {
    std::int64_t v = 0;
    const auto [next, wrong] = std::from_chars(at, end, v);
    if (wrong != std::errc() || (next < end && *next != ' ')) return {};
    numbers.push_back(v);
    at = next + 1;
  }
  if (numbers.size() < 3) return {};
  Answer a{std::uint32_t(numbers[0]), int(numbers[1]), {}};
  for (std::size_t i = 3; i < numbers.size(); ++i) a.volts.push_back(1e-6 * double(numbers[i]));
  return a;
}

speed_t baud(int rate) {
  static const std::map<int, speed_t> kRates = {{9600, B9600},     {19200, B19200},   {38400, B38400},
                                                {57600, B57600},   {115200, B115200}, {230400, B230400},
                                                {460800, B460800}, {921600, B921600}, {1000000, B1000000}};
  const auto at = kRates.find(rate);
  if (at == kRates.end())
    throw Error(
        Errc::usage, "rig.driver.baud",
        fmt::format("{} is not one of 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600, 1000000",
                    rate));
  return at->second;
}

/// A microcontroller on a serial line with the protocol of docs/formats/coil-serial.md, such as one with the
/// firmware in firmware/. It de-energises the coils by itself when commands stop: no enable line is needed.
// termios, because libserialport does not open pseudo-terminals, which the tests and the simulated board use.
class Serial final : public CoilDriver {
 public:
  struct Params {
    std::string port = "/dev/ttyACM0";
    int baud = 115200;
    int outputs = 4;
    double timeout = 0.05;
  };
  static Schema<Params> schema() {
    return Schema<Params>("serial", "A microcontroller on a serial line, with the firmware of firmware/")
        .add("port", &Params::port,
             {.doc = "Serial device, such as \"/dev/ttyACM0\" or a path in /dev/serial/by-id"})
        .add("baud", &Params::baud, {.min = 9600, .max = 1000000, .doc = "Baud rate; ignored over USB"})
        .add("outputs", &Params::outputs,
             {.min = 1, .max = 16, .doc = "Number of outputs that the firmware was built with"})
        .add("timeout", &Params::timeout,
             {.unit = "s",
              .min = 5e-3,
              .max = 1,
              .doc = "Timeout of an answer; a later answer is a device error"})
        .validity(
            "Channels and inputs are numbers, \"0\", \"1\" ... The driver was tested with the "
            "firmware on a computer behind a pseudo-terminal, not on hardware.");
  }
  Serial(const Params& p, const DriverContext& c)
      : p_(p),
        channels_(numbers(c.channels)),
        senses_(numbers(c.senses)),
        microvolts_(std::size_t(p.outputs)) {
    descriptor_ = open(p.port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) fail(std::strerror(errno));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) fail("in use by another program");
    (void)ioctl(descriptor_, TIOCEXCL);
    termios t{};
    if (tcgetattr(descriptor_, &t) != 0) fail("not a serial line");
    cfmakeraw(&t);
    cfsetspeed(&t, baud(p.baud));
    t.c_cflag |= CLOCAL | CREAD;
    if (tcsetattr(descriptor_, TCSANOW, &t) != 0) fail(std::strerror(errno));
    tcflush(descriptor_, TCIOFLUSH);
    // Outputs without a coil get the neutral voltage of the first coil, the middle of the range in the
    // firmware.
    std::ranges::fill(microvolts_, to_microvolts(c.neutral.empty() ? 0 : c.neutral[0]));
    const double until = monotonic_now() + kOpenTimeout;
    while (!answered_) {  // some boards restart when the line is opened
      if (const Status s = write(c.neutral, false); !s && monotonic_now() > until) fail(s.error);
      if (monotonic_now() > until)
        fail(
            "no answer; check that the board runs the firmware of firmware/, built with the same number of "
            "outputs");
      wait(0.02);
      receive();
    }
  }
  ~Serial() override {
    if (descriptor_ < 0) return;
    (void)ioctl(descriptor_, TIOCNXCL);
    close(descriptor_);
  }

  Status write(std::span<const double> volts, bool enable) override {
    for (std::size_t i = 0; i < volts.size(); ++i) microvolts_[channels_[i]] = to_microvolts(volts[i]);
    const std::string body = fmt::format("S {} {:d} {}", ++number_, enable, fmt::join(microvolts_, " "));
    const std::string line = fmt::format("${}*{:04X}\n", body, crc16(body));
    const double now = monotonic_now();
    if (answered_ && requested_ && now - *requested_ > p_.timeout)
      return {fmt::format("{}: no answer for {:.0f} ms", p_.port, 1e3 * (now - *requested_))};
    if (!requested_) requested_ = now;
    if (const ssize_t n = ::write(descriptor_, line.data(), line.size()); n != ssize_t(line.size()))
      return {fmt::format("{}: {}", p_.port, n < 0 ? std::strerror(errno) : "output buffer is full")};
    if (Status s = receive(); !s) return s;
    if (enable && enabled_ && state_ > 1)
      return {fmt::format("{}: the board de-energised the coils ({})", p_.port,
                          state_ == 2 ? "command timeout" : "voltage out of range")};
    enabled_ = enable && answered_number_ >= enabled_since_;
    if (!enable) enabled_since_ = number_ + 1;
    return {};
  }
  Status sense(std::span<double> volts) override {
    if (Status s = receive(); !s) return s;
    for (std::size_t i = 0; i < volts.size(); ++i)
      volts[i] = senses_[i] < sensed_.size() ? sensed_[senses_[i]] : std::nan("");
    return {};
  }
  std::string unsafe() const override { return ""; }

 private:
  static constexpr double kOpenTimeout = 3;  // s

  [[noreturn]] void fail(const std::string& what) const { throw Error(Errc::device, p_.port, what); }
  static std::int64_t to_microvolts(double v) { return std::llround(1e6 * v); }
  std::vector<std::size_t> numbers(const std::vector<std::string>& names) const {
    std::vector<std::size_t> all;
    for (const std::string& name : names) {
      int n = -1;
      const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), n);
      if (wrong != std::errc() || end != name.data() + name.size() || n < 0 || n >= p_.outputs)
        throw Error(
            Errc::usage, "rig.coil",
            fmt::format("\"{1}\" is not a channel of the serial driver; it must be an integer from 0 to {0}",
                        p_.outputs - 1, name));
      all.push_back(std::size_t(n));
    }
    return all;
  }
  void wait(double s) const {
    pollfd ready{descriptor_, POLLIN, 0};
    (void)poll(&ready, 1, int(1e3 * s));
  }
  Status receive() {
    char bytes[512];
    for (;;) {
      const ssize_t n = ::read(descriptor_, bytes, sizeof bytes);
      if (n == 0) return {p_.port + ": disconnected"};
      if (n < 0)
        return errno == EAGAIN || errno == EINTR ? Status{} : Status{p_.port + ": " + std::strerror(errno)};
      for (ssize_t i = 0; i < n; ++i) {
        if (bytes[i] != '\n') {
          if (line_.size() < sizeof bytes && bytes[i] != '\r') line_ += bytes[i];
          continue;
        }
        if (const auto a = parse_answer(line_); a && a->number <= number_) {
          answered_ = true;
          answered_number_ = a->number;
          state_ = a->state;
          sensed_ = a->volts;
          requested_.reset();
        }
        line_.clear();
      }
    }
  }

  Params p_;
  std::vector<std::size_t> channels_, senses_;
  std::vector<std::int64_t> microvolts_;
  int descriptor_ = -1;
  std::uint32_t number_ = 0, answered_number_ = 0, enabled_since_ = 1;
  std::optional<double> requested_;  ///< s, time of the oldest command without an answer
  bool answered_ = false, enabled_ = false;
  int state_ = 0;
  std::vector<double> sensed_;
  std::string line_;
};

}  // namespace

void add_serial(CoilDriverRegistry& r) { r.add<Serial>(); }

}  // namespace faba
