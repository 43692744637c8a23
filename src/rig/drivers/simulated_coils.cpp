#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/monotonic.h"
#include "rig/bench/bench_socket.h"
#include "rig/coil_driver.h"

namespace faba {
namespace {

/// The coils of a simulated bench (`faba rig simulate`), in a separate process: the connection can be slow,
/// hang or break, as with a real device.
class SimulatedCoils final : public CoilDriver {
 public:
  struct Params {
    std::string at;
  };
  static constexpr std::array kTraits = {Trait::simulated};
  static Schema<Params> schema() {
    return Schema<Params>("simulated", "The coils of a simulated bench, in a separate process")
        .add("at", &Params::at,
             {.doc =
                  "Socket of the bench, as given to `faba rig simulate --at`; default: a bench that the run "
                  "starts"})
        .validity("Channels are the indices of the coils, \"0\", \"1\" ...");
  }
  SimulatedCoils(const Params& p, const DriverContext& c)
      : at_(p.at), outputs_(channel_indices(c.channels)), inputs_(channel_indices(c.senses)) {
    socket_ = BenchSocket::connect(at_, BenchHello::Role::coils);
    BenchDevice device;
    if (socket_.read(&device, sizeof device, kMessageTimeout) != BenchSocket::Got::all)
      throw Error(Errc::device, at_, "no answer from the simulated bench; another program may use its coils");
    for (const auto& [list, key, what] :
         {std::tuple{&outputs_, "channel", "outputs"}, std::tuple{&inputs_, "sense", "inputs"}})
      for (const std::size_t n : *list)
        if (n >= device.outputs)
          throw Error(
              Errc::device, at_,
              fmt::format("the simulated bench has {} {}, \"0\", \"1\" ...; a rig.coil has {} = \"{}\"",
                          device.outputs, what, key, n));
    count_ = device.outputs;
    enable_line_ = device.enable_line != 0;
    answer_.volts.fill(std::nan(""));
  }

  Status write(std::span<const double> volts, bool enable) override {
    BenchVolts m{.outputs = count_, .enable = enable, .set = 1};
    m.volts.fill(std::nan(""));
    for (std::size_t i = 0; i < volts.size(); ++i) m.volts[outputs_[i]] = volts[i];
    if (!socket_.write(&m, sizeof m, kMessageTimeout)) return {at_ + ": simulated bench disconnected"};
    // The bench hangs: it does not execute what is sent to it.
    if (requested_ && monotonic_now() - *requested_ > kAnswerTimeout)
      return {at_ + ": no answer from the simulated bench"};
    return {};
  }
  // Sends a request and returns the previous answer: a slow bench does not block the guard.
  Status sense(std::span<double> volts) override {
    BenchSocket::Got got;
    while ((got = socket_.read(&answer_, sizeof answer_, 0)) == BenchSocket::Got::all) requested_.reset();
    const double now = monotonic_now();
    if (got == BenchSocket::Got::closed || (requested_ && now - *requested_ > kAnswerTimeout))
      return {at_ + ": no answer from the simulated bench"};
    if (!requested_) {
      const BenchVolts ask{.outputs = count_, .tell = 1};
      if (!socket_.write(&ask, sizeof ask, kMessageTimeout)) return {at_ + ": simulated bench disconnected"};
      requested_ = now;
    }
    const bool fresh = now - *requested_ < kMaxAnswerAge;
    for (std::size_t i = 0; i < volts.size(); ++i)
      volts[i] = fresh ? answer_.volts[inputs_[i]] : std::nan("");
    return {};
  }
  std::string unsafe() const override {
    return enable_line_ ? ""
                        : "no enable line: the bench keeps its last voltages if this computer fails; set "
                          "rig.bench.enable_line = true";
  }

 private:
  static constexpr double kMessageTimeout = 0.02;  // s, timeout of a message
  static constexpr double kAnswerTimeout = 1;      // s, timeout of an answer; a later one is a device error
  static constexpr double kMaxAnswerAge =
      0.03;  // s, maximum age of an answer that counts as the present current

  std::vector<std::size_t> channel_indices(const std::vector<std::string>& names) const {
    std::vector<std::size_t> n;
    for (const std::string& name : names) {
      if (name.empty() || name.size() > 2 ||
          !std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; }))
        throw Error(
            Errc::usage, "rig.coil",
            fmt::format("\"{}\" is not a channel of the simulated bench; it must be an integer", name));
      n.push_back(std::size_t(std::stoi(name)));
      if (n.back() >= kBenchOutputs)
        throw Error(Errc::usage, "rig.coil",
                    fmt::format("channel {} is out of range; the simulated bench has at most {} channels",
                                n.back(), kBenchOutputs));
    }
    return n;
  }

  std::string at_;
  std::vector<std::size_t> outputs_, inputs_;
  std::uint32_t count_ = 0;
  bool enable_line_ = true;
  BenchSocket socket_;
  BenchSense answer_;
  std::optional<double> requested_;  ///< s, time of the request without an answer
};

}  // namespace

void add_simulated_coils(CoilDriverRegistry& r) { r.add<SimulatedCoils>(); }

}  // namespace faba
