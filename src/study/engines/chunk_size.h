#pragma once
#include <cstdint>
#include <optional>

namespace faba {

/// Number of tasks for the next worker: a part of the open work, at most a minute, at the end of a round
/// less, so that all workers end at about the same time.
struct ChunkSize {
  std::uint64_t open = 0;              ///< tasks that no worker has
  unsigned slots = 1;                  ///< workers that run at a time
  std::optional<double> seconds = {};  ///< per task; empty: unknown
  bool queues = false;                 ///< chunks wait in a queue, from which they start late
  std::uint64_t tasks() const;
};

}  // namespace faba
