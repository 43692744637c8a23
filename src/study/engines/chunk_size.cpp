#include "study/engines/chunk_size.h"

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

constexpr double kShortestChunk = 1, kLongestChunk = 60;  // s
// Each worker takes this fraction of its part of the open work; the next one takes less.
constexpr double kGuided = 0.5;
// With a queue all chunks have one size: this number for each worker evens out their differences.
constexpr double kChunksPerSlot = 4;
constexpr std::uint64_t kMostUnmeasured = 20, kMostChunkTasks = 100000;

}  // namespace

std::uint64_t ChunkSize::tasks() const {
  const double each = std::ceil(double(open) / std::max(1U, slots));  // tasks per worker
  if (!seconds) {
    // One task for each worker measures the time; in a queue that would need a second submission.
    const double unmeasured = queues ? std::ceil(each / kChunksPerSlot) : 1;
    return std::clamp<std::uint64_t>(std::uint64_t(unmeasured), 1, kMostUnmeasured);
  }
  const double per_task = std::max(*seconds, 1e-7), work = each * per_task;
  const double time =
      std::clamp(queues ? work / kChunksPerSlot : work * kGuided, kShortestChunk, kLongestChunk);
  return std::clamp<std::uint64_t>(std::uint64_t(time / per_task), 1, std::min(open, kMostChunkTasks));
}

}  // namespace faba
