// faba-coil-guard: the process that owns the coil driver. Started by faba, never manually; see
// rig/guard/guard_loop.h.
#include <sys/mman.h>
#include <sys/socket.h>

#include <cstdio>

#include "core/threads/urgent.h"
#include "rig/guard/guard_loop.h"
#include "rig/setup/guard_setup.h"

namespace {

constexpr std::size_t kLongestSetup = 200'000;  // bytes

void refuse(const std::string& why) {
  faba::GuardReport r;
  r.state = faba::CoilGuard::State::tripped;
  r.fault = faba::CoilGuard::Fault::device;
  why.copy(r.reason.data(), r.reason.size() - 1);
  (void)send(faba::kGuardDescriptor, &r, sizeof r, MSG_NOSIGNAL);
}

int guard() {
  using namespace faba;
  std::string text(kLongestSetup, '\0');
  const ssize_t n = recv(kGuardDescriptor, text.data(), text.size(), 0);
  if (n <= 0) {
    std::fputs(
        "faba-coil-guard: is started by faba, for example by `faba rig run`; do not start it directly\n",
        stderr);
    return int(Errc::usage);
  }
  text.resize(std::size_t(n));
  const GuardSetup setup = GuardSetup::read(Json::parse(text), builtin_coil_drivers());
  std::unique_ptr<OutputFile> log;
  if (!setup.log.empty()) log = std::make_unique<OutputFile>(setup.log);
  GuardLoop loop(kGuardDescriptor, CoilGuard(setup.guard, setup.bounds(), setup.frame_period),
                 CoilWiring(setup.coils), setup.driver.make(setup.context()), std::move(log));
  // Reduces latency if the system permits it; the deadlines do not depend on it.
  const Urgent urgent;
  (void)mlockall(MCL_CURRENT | MCL_FUTURE);
  return loop.run() ? 0 : int(Errc::device);
}

}  // namespace

int main() {
  try {
    return guard();
  } catch (const std::exception& e) {  // before the loop, so there is no current yet
    refuse(e.what());
    return int(faba::Errc::device);
  }
}
