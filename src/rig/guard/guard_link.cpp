#include "rig/guard/guard_link.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/monotonic.h"
#include "core/process/child.h"
#include "core/threads/urgent.h"

namespace faba {
namespace {

constexpr double kOpenTimeout = 10;   // s, timeout for opening the device
constexpr double kAnswerTimeout = 2;  // s, timeout for an answer of the guard
constexpr double kReportTimeout = 1;  // s without a report (ten per second are sent): the guard hangs
constexpr double kExitTimeout = 5;  // s, timeout for the end of the guard, which de-energises the coils again
constexpr double kBeatsPerTimeout = 8;  // tolerates late heartbeats
constexpr double kEarlyFraction =
    0.7;  // fraction of the guard's deadline: de-energises before it, even if one heartbeat is late

[[noreturn]] void fail(const std::string& what) { throw Error(Errc::device, "coil guard", what); }

}  // namespace

GuardLink::GuardLink(const GuardSetup& setup, const std::filesystem::path& guard)
    : coils_(setup.coils.size()),
      early_timeout_(kEarlyFraction *
                     CoilGuard(setup.guard, setup.bounds(), setup.frame_period).command_deadline()) {
  if (coils_ > kMostCoils) fail(fmt::format("{} coils are too many; at most {}", coils_, kMostCoils));
  const std::string program = guard.string();
  int sockets[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0) fail(std::strerror(errno));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  // Through an intermediate descriptor: dup2 onto itself would keep the close-on-exec flag.
  posix_spawn_file_actions_adddup2(&files, sockets[1], kGuardDescriptor + 1);
  posix_spawn_file_actions_adddup2(&files, kGuardDescriptor + 1, kGuardDescriptor);
  posix_spawn_file_actions_addclosefrom_np(&files, kGuardDescriptor + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);  // only the program handles Ctrl-C
  char* const arguments[] = {const_cast<char*>(program.c_str()), nullptr};
  const int error = posix_spawn(&process_, program.c_str(), &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(sockets[1]);
  link_ = sockets[0];
  if (error != 0) {
    close(link_);
    fail(fmt::format("cannot start {}: {}", program, std::strerror(error)));
  }
  const std::string text = setup.to_json().dump();
  try {
    if (send(link_, text.data(), text.size(), MSG_NOSIGNAL) != ssize_t(text.size()))
      fail("the guard process does not respond");
    const GuardReport first = wait_for([](const GuardReport&) { return true; }, kOpenTimeout);
    if (first.state == CoilGuard::State::tripped) fail(first.reason.data());
  } catch (...) {
    close_link();
    throw;
  }
  const double pause =
      std::min(setup.guard.heartbeat_deadline, early_timeout_ / kEarlyFraction) / kBeatsPerTimeout;
  heartbeat_ = std::jthread([this, pause](const std::stop_token& stop) { send_heartbeats(stop, pause); });
}

// Sends heartbeats, and de-energises the coils after a command timeout.
void GuardLink::send_heartbeats(const std::stop_token& stop, double pause) {
  const Urgent urgent;
  while (!stop.stop_requested()) {
    double wait = pause;
    {
      const std::lock_guard lock(mutex_);
      if (early_timeout_enabled_ && energised_ && monotonic_now() - requested_ > early_timeout_) {
        send_message({.kind = ToGuard::Kind::request, .number = ++number_, .frame_t = std::nan("")});
        energised_ = false;
        coils_off_ = true;
        ++command_timeouts_;
      } else {
        send_message({.kind = ToGuard::Kind::heartbeat});
        if (early_timeout_enabled_ && energised_)
          wait = std::min(wait, requested_ + early_timeout_ - monotonic_now());
      }
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
  }
}

GuardLink::~GuardLink() {
  disarm();
  heartbeat_.request_stop();
  if (heartbeat_.joinable()) heartbeat_.join();
  close_link();
}

// Closing the link ends the guard. Waits for it, because it may still be de-energising the device.
void GuardLink::close_link() noexcept {
  close(link_);
  end_child(process_, kExitTimeout);
}

bool GuardLink::send_message(ToGuard m) const {
  m.sent = monotonic_now();
  m.coils = std::uint32_t(coils_);
  return send(link_, &m, sizeof m, MSG_DONTWAIT | MSG_NOSIGNAL) == ssize_t(sizeof m);
}

// Reads all available reports. False if the guard has ended or hangs; then it counts as lost for ever.
bool GuardLink::drain() {
  GuardReport r;
  while (!lost_) {
    const ssize_t n = recv(link_, &r, sizeof r, MSG_DONTWAIT);
    if (n == ssize_t(sizeof r)) {
      last_ = r;
      received_ = monotonic_now();
      if (r.number > 0 && on_answer) on_answer(r);
    } else if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
      if (monotonic_now() - received_ < kReportTimeout) return true;
      mark_lost("the guard process does not respond");
      last_.write_ok = false;
    } else {
      mark_lost("the guard process has ended");
    }
  }
  return false;
}

void GuardLink::mark_lost(const char* why) {
  lost_ = true;
  last_.state = CoilGuard::State::tripped;
  if (last_.reason[0] == 0) std::strncpy(last_.reason.data(), why, last_.reason.size() - 1);
}

GuardReport GuardLink::wait_for(const std::function<bool(const GuardReport&)>& condition, double patience) {
  const double until = monotonic_now() + patience;
  for (;;) {
    pollfd ready{link_, POLLIN, 0};
    (void)poll(&ready, 1, 50);
    GuardReport r;
    while (recv(link_, &r, sizeof r, MSG_DONTWAIT) == ssize_t(sizeof r)) {
      last_ = r;
      received_ = monotonic_now();
      if (condition(r)) return r;
    }
    if (ready.revents & (POLLHUP | POLLERR)) fail("the guard process has ended; the coils are de-energised");
    if (monotonic_now() > until) fail("no answer from the device");
  }
}

void GuardLink::arm() {
  if (!drain() || !send_message({.kind = ToGuard::Kind::arm})) fail(last_.reason.data());
  const GuardReport r =
      wait_for([](const GuardReport& g) { return g.state != CoilGuard::State::disarmed; }, kAnswerTimeout);
  if (r.state == CoilGuard::State::tripped) fail(r.reason.data());
}

void GuardLink::disarm() noexcept {
  try {
    {
      const std::lock_guard lock(mutex_);
      energised_ = coils_off_ = false;  // no command timeout after the end
    }
    if (send_message({.kind = ToGuard::Kind::disarm}) && !lost_)
      wait_for([](const GuardReport& g) { return g.state != CoilGuard::State::armed; }, kAnswerTimeout);
  } catch (const std::exception&) {
    return;  // closing the link, which follows, disarms too
  }
}

void GuardLink::reset() {
  if (!drain() || !send_message({.kind = ToGuard::Kind::reset})) fail(last_.reason.data());
  wait_for([](const GuardReport& g) { return g.state == CoilGuard::State::disarmed; }, kAnswerTimeout);
}

std::optional<std::uint64_t> GuardLink::request(std::span<const double> current, double frame_t) {
  drain();
  const std::lock_guard lock(mutex_);
  if (coils_off_) return {};
  ToGuard m{.kind = ToGuard::Kind::request, .number = ++number_, .frame_t = frame_t};
  std::copy(current.begin(), current.end(), m.current.begin());
  send_message(m);
  requested_ = monotonic_now();
  energised_ = std::any_of(current.begin(), current.end(), [](double i) { return i != 0; });
  return number_;
}

bool GuardLink::clear_timeout() {
  const std::lock_guard lock(mutex_);
  return std::exchange(coils_off_, false);
}

GuardReport GuardLink::report() {
  drain();
  return last_;
}

}  // namespace faba
