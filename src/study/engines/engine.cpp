#include "study/engines/engine.h"

#include <algorithm>

namespace faba {

// Without a queue, an attempt starts when a worker is free. A queue is filled when half of it is used; while
// the time of a task is unknown, a few workers measure it.
std::size_t Engine::accepts(std::size_t running, bool measured) const {
  if (!queues()) return slots() - std::min<std::size_t>(running, slots());
  if (!measured) return running == 0 ? std::min(slots(), kMeasuringWorkers) : 0;
  const std::size_t most = std::size_t(kQueuedPerSlot) * slots();
  return running <= most / 2 ? most - running : 0;
}

std::vector<std::string> WorkerCommand::words(const Attempt& a) const {
  return {program.string(), "study", "work",      directory.string(), "--quiet",
          "--tasks",        a.tasks, "--results", a.results.string()};
}

}  // namespace faba
