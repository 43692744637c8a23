#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "vision/flow/flow.h"

namespace faba {

/// Flows that one reading of a video has computed, for the next one; as many as fit into a limited amount of
/// memory. Several threads may use it at the same time.
class KeptFlows {
 public:
  static constexpr std::size_t kBytes = std::size_t{320} << 20;

  /// Keeps a copy of the flow between frames `frame` and `frame` + 1, if there is room.
  void keep(std::uint64_t frame, const Flow& flow);
  /// Removes and returns the flow; empty if it is not kept.
  std::optional<Flow> take(std::uint64_t frame);

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, Flow> flows_;
  std::size_t bytes_ = 0;
};

}  // namespace faba
