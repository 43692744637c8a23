#include "core/child.h"

#include <signal.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "core/monotonic.h"

namespace faba {

void end_child(pid_t process, double timeout) noexcept {
  if (process <= 0) return;
  kill(process, SIGCONT);
  for (const double until = monotonic_now() + timeout; monotonic_now() < until;) {
    const pid_t ended = waitpid(process, nullptr, WNOHANG);
    if (ended == process || (ended < 0 && errno != EINTR)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  kill(process, SIGKILL);
  while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace faba
