#pragma once
#include <memory>
#include <optional>

#include "core/parallel.h"
#include "core/registry.h"
#include "vision/image/image.h"

namespace faba {

/// How everything moved from one frame to the next: u to the right, v down (image frame), px per pair of
/// frames.
struct Flow {
  GrayF u, v;
  int width() const { return u.width; }
  int height() const { return u.height; }
};

/// What an iterative method took for a pair of frames.
struct FlowEffort {
  int iterations = 0;
  bool converged = false;  ///< false: the limit of iterations came first
};

/// A way to get the flow between two frames. Keeps memory from pair to pair: not to be shared between
/// threads.
class FlowMethod {
 public:
  virtual ~FlowMethod() = default;
  /// `a` and `b` have the same size, greys on a scale of 0 to 255; `out` is resized as needed. Same frames,
  /// same result.
  virtual void between(const GrayF& a, const GrayF& b, Flow& out) = 0;
  /// What the last pair took; empty for a method that does not iterate.
  virtual std::optional<FlowEffort> effort() const { return {}; }
};

/// What every flow part may use. Outlives the part.
struct FlowContext {
  Pool* pool;
};
using FlowRegistry = Registry<FlowMethod, FlowContext>;

}  // namespace faba
