#include "rig/guard/guard_loop.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <thread>

#include "core/monotonic.h"

namespace faba {
namespace {

volatile sig_atomic_t end_requested = 0;

constexpr double kSensePeriod = 0.01;  // s between readings of the inputs
constexpr double kStatusPeriod = 0.1;  // s between reports without a request
constexpr double kDisablePeriod = 1;   // s during which a failing device is retried

}  // namespace

GuardLoop::GuardLoop(int link, CoilGuard guard, CoilWiring wiring, std::unique_ptr<CoilDriver> driver,
                     std::unique_ptr<OutputFile> log)
    : link_(link),
      guard_(std::move(guard)),
      wiring_(std::move(wiring)),
      driver_(std::move(driver)),
      log_(std::move(log)),
      written_current_(wiring_.coils().size(), 0.0) {
  sensed_.fill(std::nan(""));
}

void GuardLoop::log_event(const std::string& what) {
  if (!log_) return;
  try {
    log_->append(fmt::format("{:.6f} {}\n", monotonic_now(), what));
  } catch (const Error& e) {
    log_failure_ = e.what();
    log_.reset();  // a full disk must not stop the guard
  }
}

// Only after the coils are de-energised for the last time: a slow disk must not delay an answer of the guard.
void GuardLoop::sync_log() {
  if (!log_) return;
  try {
    log_->sync();
  } catch (const Error& e) {
    log_failure_ = e.what();
    report();
  }
}

void GuardLoop::report(std::uint64_t number, double sent) {
  reported_ = monotonic_now();
  GuardReport r;
  r.state = guard_.state();
  r.fault = guard_.fault();
  r.write_ok = write_ok_;
  r.number = number;
  r.sent = sent;
  r.done = done_;
  r.heat = guard_.heat();
  r.passed = guard_.passed();
  r.refused = guard_.refused();
  r.sensed = sensed_;
  const std::string why = guard_.state() == CoilGuard::State::disarmed ? driver_->unsafe() : guard_.reason();
  why.copy(r.reason.data(), r.reason.size() - 1);
  log_failure_.copy(r.log_failure.data(), r.log_failure.size() - 1);
  // A client that does not read misses reports; the guard does not wait for it.
  (void)send(link_, &r, sizeof r, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void GuardLoop::write_outputs(double now) {
  const bool enable = guard_.state() == CoilGuard::State::armed;
  if (guard_.current() == written_current_ && enable == written_enable_ &&
      now - written_ < driver_->write_period())
    return;
  const Status s = driver_->write(wiring_.volts(guard_.current()), enable);
  write_ok_ = bool(s);
  if (!s) {
    guard_.fail(CoilGuard::Fault::device, s.error, now);
    write_ok_ = bool(driver_->write(wiring_.neutral(), false));
  }
  written_current_ = guard_.current();
  written_enable_ = guard_.state() == CoilGuard::State::armed;
  written_ = monotonic_now();
}

void GuardLoop::execute(const ToGuard& m, double now) {
  guard_.heartbeat(now);
  switch (m.kind) {
    case ToGuard::Kind::heartbeat:
      return;
    case ToGuard::Kind::arm:
      if (const std::string why = driver_->unsafe(); !why.empty())
        guard_.fail(CoilGuard::Fault::device, why, now);
      else
        guard_.arm(now);
      break;
    case ToGuard::Kind::disarm:
      guard_.disarm(now);
      break;
    case ToGuard::Kind::reset:
      guard_.reset();
      break;
    case ToGuard::Kind::request:
      guard_.take(
          {m.number, m.sent, m.frame_t, {m.current.data(), std::min<std::size_t>(m.coils, kMostCoils)}}, now);
      break;
  }
  write_outputs(now);
  done_ = monotonic_now();
  report(m.kind == ToGuard::Kind::request ? m.number : 0, m.sent);
}

void GuardLoop::receive() {
  ToGuard m;
  for (;;) {
    const ssize_t n = recv(link_, &m, sizeof m, MSG_DONTWAIT | MSG_TRUNC);
    const double now = monotonic_now();
    if (n == ssize_t(sizeof m)) {
      guard_.check(now);  // a timeout before this message is still a fault
      execute(m, now);
    } else if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
      return;
    } else {
      if (guard_.state() == CoilGuard::State::armed) guard_.fail(CoilGuard::Fault::disconnected, "", now);
      stop_ = true;
      return;
    }
  }
}

void GuardLoop::serve(double now) {
  if (!wiring_.senses().empty() && now - sensed_at_ >= kSensePeriod) {
    std::vector<double> volts(wiring_.senses().size());
    if (const Status s = driver_->sense(volts); !s) {
      guard_.fail(CoilGuard::Fault::device, s.error, now);
    } else {
      const std::vector<double> amps = wiring_.sensed(volts);
      std::copy(amps.begin(), amps.end(), sensed_.begin());
      guard_.sensed(amps, now);
    }
    sensed_at_ = now;
  }
  guard_.check(now);
  write_outputs(now);
  if (now - reported_ >= kStatusPeriod) report();
  if (guard_.state() == logged_state_) return;
  logged_state_ = guard_.state();
  log_event(logged_state_ == CoilGuard::State::tripped
                ? fmt::format("tripped {}: {}{}", word(guard_.fault()), guard_.reason(),
                              write_ok_ ? "" : "; the coils could not be de-energised")
                : word(logged_state_));
  report();
}

bool GuardLoop::deenergise() {
  const double began = monotonic_now();
  Status s;
  do {
    s = driver_->write(wiring_.neutral(), false);
    if (s) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (monotonic_now() - began < kDisablePeriod);
  log_event("the coils could not be de-energised: " + s.error);
  return false;
}

bool GuardLoop::run() {
  struct sigaction action {};
  action.sa_handler = [](int) { end_requested = 1; };
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGQUIT}) sigaction(s, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
  sigset_t closed, open;
  sigfillset(&closed);
  sigprocmask(SIG_SETMASK, &closed, &open);
  sigemptyset(&open);
  log_event("disarmed");
  report();
  while (!stop_) {
    const double now = monotonic_now();
    double wait = driver_->write_period() - (now - written_);
    if (!wiring_.senses().empty()) wait = std::min(wait, kSensePeriod - (now - sensed_at_));
    if (guard_.state() == CoilGuard::State::armed) wait = std::min(wait, guard_.due() - now);
    wait = std::clamp(wait, 0.0, 1.0);
    const timespec timeout{time_t(wait), long(1e9 * (wait - std::floor(wait)))};
    pollfd ready{link_, POLLIN, 0};
    (void)ppoll(&ready, 1, &timeout, &open);
    if (end_requested) {
      guard_.fail(CoilGuard::Fault::signal, "", monotonic_now());
      stop_ = true;
    }
    if (ready.revents) receive();
    serve(monotonic_now());
  }
  report();
  const bool coils_off = deenergise();
  sync_log();
  return coils_off;
}

}  // namespace faba
