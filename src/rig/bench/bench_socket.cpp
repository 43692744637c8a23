#include "rig/bench/bench_socket.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/monotonic.h"

namespace faba {
namespace {

constexpr double kHelloTime = 2;  // s

sockaddr_un address(const std::filesystem::path& path) {
  sockaddr_un a{};
  a.sun_family = AF_UNIX;
  const std::string name = path.string();
  if (name.size() >= sizeof a.sun_path)
    throw Error(Errc::device, name,
                fmt::format("socket path is too long; at most {} characters", sizeof a.sun_path - 1));
  std::memcpy(a.sun_path, name.c_str(), name.size() + 1);
  return a;
}

int local_socket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

int connect_to(int descriptor, const sockaddr_un& a) {
  return ::connect(descriptor, reinterpret_cast<const sockaddr*>(&a), sizeof a);
}

bool ready(int descriptor, short what, double until) {
  const double left = until - monotonic_now();
  pollfd p{descriptor, what, 0};
  return poll(&p, 1, left > 0 ? int(1e3 * left) + 1 : 0) > 0;
}

}  // namespace

BenchSocket::BenchSocket(BenchSocket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
BenchSocket& BenchSocket::operator=(BenchSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}
BenchSocket::~BenchSocket() { close(); }

void BenchSocket::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

BenchSocket BenchSocket::connect(const std::filesystem::path& path, BenchHello::Role role) {
  const sockaddr_un a = address(path);
  BenchSocket s(local_socket());
  if (!s || connect_to(s.descriptor_, a) != 0)
    throw Error(
        Errc::device, path.string(),
        fmt::format("no simulated bench found ({}); start one with `faba rig simulate SCENE.toml --at {}`",
                    std::strerror(errno), path.string()));
  const BenchHello hello{kBenchVersion, role};
  if (!s.write(&hello, sizeof hello, kHelloTime))
    throw Error(Errc::device, path.string(), "the simulated bench does not respond");
  return s;
}

BenchSocket BenchSocket::listen(const std::filesystem::path& path) {
  // Clients connect as soon as the name exists: the socket gets its final name only after listen().
  const std::string early = path.string() + ".new";
  const sockaddr_un a = address(early);
  unlink(early.c_str());
  BenchSocket s(local_socket());
  // A killed bench leaves a stale socket file, on which no process listens.
  if (std::error_code ec; std::filesystem::is_socket(path, ec)) {
    const sockaddr_un old = address(path);
    const BenchSocket knock(local_socket());
    if (connect_to(knock.descriptor_, old) != 0 && errno == ECONNREFUSED) unlink(path.c_str());
  }
  const bool listens = s && bind(s.descriptor_, reinterpret_cast<const sockaddr*>(&a), sizeof a) == 0 &&
                       ::listen(s.descriptor_, 4) == 0 && link(early.c_str(), path.c_str()) == 0;
  const int why = errno;
  unlink(early.c_str());
  std::error_code ec;
  if (const auto folder = path.parent_path();
      !listens && why == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ec))
    throw Error(Errc::device, path.string(), fmt::format("folder {} not found", folder.string()));
  if (!listens)
    throw Error(Errc::device, path.string(),
                why == EEXIST ? "already exists (a running bench or another file); choose another name"
                              : fmt::format("cannot listen on this socket: {}", std::strerror(why)));
  return s;
}

BenchSocket BenchSocket::accept(double patience) {
  if (!ready(descriptor_, POLLIN, monotonic_now() + patience)) return {};
  return BenchSocket(accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

bool BenchSocket::hung_up() const {
  pollfd p{descriptor_, POLLRDHUP, 0};
  return descriptor_ < 0 || (poll(&p, 1, 0) > 0 && (p.revents & (POLLRDHUP | POLLHUP | POLLERR)));
}

BenchSocket::Got BenchSocket::read(void* to, std::size_t bytes, double patience) {
  const double until = monotonic_now() + patience;
  auto* at = static_cast<char*>(to);
  std::size_t got = 0;
  while (got < bytes) {
    const ssize_t n = recv(descriptor_, at + got, bytes - got, 0);
    if (n > 0) {
      got += std::size_t(n);
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
      return Got::closed;
    } else if (!ready(descriptor_, POLLIN, got > 0 ? until + kHelloTime : until)) {
      return got > 0 ? Got::closed : Got::nothing;
    }
  }
  return Got::all;
}

bool BenchSocket::write(const void* from, std::size_t bytes, double patience) {
  const double until = monotonic_now() + patience;
  const auto* at = static_cast<const char*>(from);
  std::size_t put = 0;
  while (put < bytes) {
    const ssize_t n = send(descriptor_, at + put, bytes - put, MSG_NOSIGNAL);
    if (n > 0)
      put += std::size_t(n);
    else if ((errno != EAGAIN && errno != EINTR) || !ready(descriptor_, POLLOUT, until))
      return false;
  }
  return true;
}

}  // namespace faba
