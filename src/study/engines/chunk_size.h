#pragma once
#include <cstdint>
#include <optional>

namespace faba {

/// Number of tasks for the next worker. A worker computes for 10 to 60 s if there is enough work, because
/// its start takes a tenth of a second, in a queue more; at the end of a round less, so that all workers end
/// at about the same time.
struct ChunkSize {
  std::uint64_t open = 0;              ///< tasks that no worker has
  unsigned slots = 1;                  ///< workers that run at a time
  std::optional<double> seconds = {};  ///< per task; empty: unknown
  bool queues = false;                 ///< all chunks are submitted at once
  std::uint64_t tasks() const;
};

}  // namespace faba
