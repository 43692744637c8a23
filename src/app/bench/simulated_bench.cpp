#include "app/bench/simulated_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "app/run/simulation.h"
#include "core/file.h"
#include "core/monotonic.h"
#include "rig/bench/bench_socket.h"
#include "vision/image/image.h"

namespace faba {
namespace {

constexpr double kSocketPeriod = 1e-3;   // s between polls of the sockets and log lines while currents change
constexpr double kMessageTimeout = 0.5;  // s to send or receive a message of a few bytes
constexpr double kFrameTimeout = 10;     // s to send a frame; a new client opens its coils first
constexpr auto kClientPollPeriod = std::chrono::milliseconds(10);  // checks whether a client is connected
constexpr double kLongestStep = 2e-3;        // s, of the world; a command takes effect at the next step
constexpr double kCellStepsPerSecond = 2e7;  // a fifth of the speed of a core (bench/results/agents.md)
constexpr double kFirstClientTimeout = 30;   // s with --once, until the first client connects
constexpr double kNoClientTimeout = 5;       // s with --once, after the last client has disconnected
constexpr double kLoggedChange = 1e-5;       // A, minimum change of a logged current

struct CoilEvent {
  double t;
  std::vector<double> volts;
  bool enable;
};

// Coil side: receives voltages and logs the currents.
class Coils {
 public:
  Coils(const BenchParams& p, std::size_t outputs, const std::filesystem::path& log)
      : p_(p), amplifier_(p.amplifier, outputs), outputs_(outputs), volts_(outputs, p.amplifier.reference) {
    if (log.empty()) return;
    log_ = std::make_unique<OutputFile>(log);
    std::string head = "t_s,enable,relay";
    for (std::size_t k = 0; k < outputs; ++k) head += fmt::format(",volts_{}", k);
    for (std::size_t k = 0; k < outputs; ++k) head += fmt::format(",current_{}_a", k);
    log_->append(head + '\n');
  }

  void connect(BenchSocket s) {
    const BenchDevice device{std::uint32_t(outputs_), p_.amplifier.enable_line ? 1U : 0U};
    socket_ = std::move(s);
    if (!socket_.write(&device, sizeof device, kMessageTimeout)) socket_.close();
  }
  bool connected() const { return bool(socket_); }

  // Reads the received messages; to be called every kSocketPeriod.
  void work() {
    BenchVolts m;
    while (socket_) {
      const auto got = socket_.read(&m, sizeof m, 0);
      if (got == BenchSocket::Got::nothing) break;
      if (got == BenchSocket::Got::closed) {
        socket_.close();  // the voltages do not change, as with an unplugged device
        break;
      }
      if (m.set) take(m);
      if (m.tell) send_sensed();
    }
    record(monotonic_now());
  }
  // Removes and returns the events until time t, for the world.
  std::vector<CoilEvent> until(double t) {
    const std::lock_guard lock(mutex_);
    std::vector<CoilEvent> due;
    while (!events_.empty() && events_.front().t <= t) {
      due.push_back(std::move(events_.front()));
      events_.pop_front();
    }
    return due;
  }

 private:
  void take(const BenchVolts& m) {
    const double now = monotonic_now();
    for (std::size_t k = 0; k < outputs_; ++k)
      if (!std::isnan(m.volts[k])) volts_[k] = m.volts[k];
    enable_ = m.enable != 0;
    amplifier_.take(volts_, enable_, now);
    {
      const std::lock_guard lock(mutex_);
      events_.push_back({now, volts_, enable_});
    }
    record(now);
  }
  void send_sensed() {
    BenchSense answer;
    amplifier_.at(monotonic_now());
    const std::vector<double> volts = amplifier_.sensed();
    std::copy(volts.begin(), volts.end(), answer.volts.begin());
    if (!socket_.write(&answer, sizeof answer, kMessageTimeout)) socket_.close();
  }
  void record(double now) {
    if (!log_) return;
    const std::vector<double>& i = amplifier_.at(now);
    bool changed = logged_.empty() || relay_ != amplifier_.enabled() || logged_enable_ != enable_;
    for (std::size_t k = 0; k < outputs_ && !changed; ++k)
      changed = std::fabs(i[k] - logged_[k]) > kLoggedChange || volts_[k] != logged_[outputs_ + k];
    if (!changed) return;
    relay_ = amplifier_.enabled();
    logged_enable_ = enable_;
    logged_ = i;
    logged_.insert(logged_.end(), volts_.begin(), volts_.end());
    log_->append(fmt::format("{:.6f},{},{},{:.6g},{:.6g}\n", now, int(enable_), int(relay_),
                             fmt::join(volts_, ","), fmt::join(i, ",")));
  }

  BenchParams p_;
  Amplifier amplifier_;
  std::size_t outputs_;
  std::vector<double> volts_;
  bool enable_ = false, relay_ = false, logged_enable_ = false;
  std::vector<double> logged_;
  BenchSocket socket_;
  std::unique_ptr<OutputFile> log_;
  std::mutex mutex_;
  std::deque<CoilEvent> events_;
};

// Camera side: sends the newest frame to the connected client.
class Sender {
 public:
  explicit Sender(double rate) : rate_(rate), thread_([this](const std::stop_token& s) { work(s); }) {}
  ~Sender() {
    thread_.request_stop();
    came_.notify_all();
  }
  void connect(BenchSocket s) {
    const std::lock_guard lock(mutex_);
    fresh_ = std::move(s);
    connected_ = true;
  }
  bool connected() const { return connected_; }
  void offer(std::uint64_t number, double t, ImageRef image, bool corrupt) {
    const std::lock_guard lock(mutex_);
    if (image_ && connected_) ++unfetched_;
    number_ = number;
    t_ = t;
    image_ = std::move(image);
    corrupt_ = corrupt;
    came_.notify_all();
  }
  std::uint64_t unfetched() const { return unfetched_; }

 private:
  void work(const std::stop_token& stop) {
    BenchSocket socket;
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      came_.wait_for(lock, kClientPollPeriod, [&] { return image_ || stop.stop_requested(); });
      if (socket && socket.hung_up()) {
        socket.close();
        connected_ = bool(fresh_);
      }
      if (fresh_) {
        socket = std::move(fresh_);
        fresh_ = BenchSocket();
      }
      if (!image_) continue;
      const ImageRef image = std::exchange(image_, nullptr);
      const BenchFrame head{number_, t_, image->width, image->height, rate_, corrupt_ ? 1U : 0U};
      if (!socket) continue;
      lock.unlock();
      const bool sent = socket.write(&head, sizeof head, kFrameTimeout) &&
                        socket.write(image->px.data(), image->px.size(), kFrameTimeout);
      if (!sent) socket.close();
      lock.lock();
      if (!sent && !fresh_) connected_ = false;
    }
  }

  double rate_;
  std::mutex mutex_;
  std::condition_variable came_;
  BenchSocket fresh_;
  std::uint64_t number_ = 0;
  double t_ = 0;
  ImageRef image_;
  bool corrupt_ = false;
  std::atomic<bool> connected_ = false;
  std::atomic<std::uint64_t> unfetched_ = 0;
  std::jthread thread_;
};

/// The scenario with camera pictures, and with steps that a machine can compute in real time.
Scenario in_real_time(Scenario s) {
  s.camera.sensor = CameraParams::Sensor::frames;
  s.camera.delay_frames = 0;
  double cells = 0;
  for (const Swarm& swarm : s.swarms) cells += double(swarm.params.count);
  s.simulation.longest = std::max(kLongestStep, cells / kCellStepsPerSecond);
  return s;
}

// The lower half of the picture is lost, as when a part of the transfer is.
ImageRef damaged(const Gray8& picture) {
  auto out = std::make_shared<Gray8>(picture);
  std::fill(out->px.begin() + std::ptrdiff_t(out->px.size() / 2), out->px.end(), std::uint8_t(0));
  return out;
}

void accept_client(BenchSocket client, Coils& coils, Sender& sender) {
  BenchHello hello;
  if (client.read(&hello, sizeof hello, kMessageTimeout) != BenchSocket::Got::all ||
      hello.version != kBenchVersion)
    return;
  // One client per role: the connection of a second one is closed.
  // The client before may have disconnected since the last call of work().
  if (hello.role == BenchHello::Role::coils && coils.connected()) coils.work();
  if (hello.role == BenchHello::Role::coils && !coils.connected())
    coils.connect(std::move(client));
  else if (hello.role == BenchHello::Role::camera && !sender.connected())
    sender.connect(std::move(client));
}

}  // namespace

SimulatedBench::Summary SimulatedBench::run(Scenario s, std::uint64_t seed, Pool& pool, const Options& o) {
  if (!s.rig) throw Error(Errc::usage, "rig", "the table [rig] is missing; add it, as in scenes/bench.toml");
  const BenchParams bench = s.rig->bench;
  s = in_real_time(std::move(s));
  Simulation simulation(s, seed, pool);
  World& world = simulation.world();
  const std::size_t outputs = world.parts().field->coils();

  BenchSocket listener = BenchSocket::listen(o.at);
  struct Unlink {
    std::filesystem::path at;
    ~Unlink() {
      std::error_code ec;
      std::filesystem::remove(at, ec);
    }
  } unlink{o.at};
  Coils coils(bench, outputs, o.log);
  if (o.ready) o.ready();
  Sender sender(s.camera.rate);
  std::atomic<bool> no_clients = false;
  std::jthread io([&](const std::stop_token& stop) {
    double until = monotonic_now() + kFirstClientTimeout;
    while (!stop.stop_requested()) {
      coils.work();  // first, to release the role of a client that has disconnected
      if (BenchSocket client = listener.accept(0)) accept_client(std::move(client), coils, sender);
      if (coils.connected() || sender.connected()) until = monotonic_now() + kNoClientTimeout;
      if (o.once && monotonic_now() > until) no_clients = true;
      std::this_thread::sleep_for(std::chrono::duration<double>(kSocketPeriod));
    }
  });

  Summary summary;
  Amplifier amplifier(bench.amplifier, outputs);
  const double began = monotonic_now();
  const auto stopped = [&] { return no_clients || (o.stop && o.stop->load()); };
  simulation.rig().before_steps([&] {
    // A step is computed after its end in real time, when all currents during it are known.
    const double t = began + world.state().t, over = t + world.parts().dt;
    for (double left = over - monotonic_now(); left > 0 && !stopped(); left = over - monotonic_now())
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, 0.05)));
    summary.behind = std::max(summary.behind, monotonic_now() - over);
    for (const CoilEvent& e : coils.until(t)) amplifier.take(e.volts, e.enable, e.t);
    world.command(amplifier.at(t));
    return !stopped();
  });
  Observation seen;
  while (!stopped() && simulation.rig().read(seen)) {
    ++summary.frames;
    const double t = began + seen.t;
    const bool frozen = bench.freeze_after && seen.t >= *bench.freeze_after;
    const std::uint64_t number = seen.frame + 1;
    const bool corrupt = bench.corrupt_one_of > 0 && number % std::uint64_t(bench.corrupt_one_of) == 0;
    if (!frozen) sender.offer(number, t, corrupt ? damaged(*seen.image) : seen.image, corrupt);
  }
  summary.unfetched = sender.unfetched();
  return summary;
}

}  // namespace faba
