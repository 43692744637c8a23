#include "study/engines/chunk_size.h"

#include <algorithm>
#include <cmath>

#include "study/engines/engine.h"

namespace faba {
namespace {

// s. The start of a worker takes about 0.1 s, by a queue about 1 s.
constexpr double kShortestChunk = 1, kShortestQueued = 5, kLongestChunk = 60;
// Each worker takes this fraction of its part of the open work; the next one takes less.
constexpr double kGuided = 0.5, kGuidedQueued = 1.0 / Engine::kQueuedPerSlot;
constexpr std::uint64_t kMostUnmeasured = 20, kMostChunkTasks = 100000;

}  // namespace

std::uint64_t ChunkSize::tasks() const {
  const double each = std::ceil(double(open) / std::max(1U, slots));  // tasks per worker
  if (!seconds) {
    // One task for each worker measures the time; workers that wait in a queue get more.
    const double unmeasured = queues ? std::ceil(each * kGuidedQueued) : 1;
    return std::clamp<std::uint64_t>(std::uint64_t(unmeasured), 1, kMostUnmeasured);
  }
  const double per_task = std::max(*seconds, 1e-7), work = each * per_task;
  const double time = std::clamp(work * (queues ? kGuidedQueued : kGuided),
                                 queues ? kShortestQueued : kShortestChunk, kLongestChunk);
  // Less when all workers get work by it; a queue takes no job below the shortest chunk.
  const double even = queues ? std::max(each, std::ceil(kShortestChunk / per_task)) : each;
  return std::clamp<std::uint64_t>(std::uint64_t(std::min(time / per_task, even)), 1,
                                   std::min(open, kMostChunkTasks));
}

}  // namespace faba
