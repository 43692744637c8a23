#pragma once
#include <memory>

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

/// A way to get the flow between two frames. Keeps memory from pair to pair: not to be shared between
/// threads.
class FlowMethod {
 public:
  virtual ~FlowMethod() = default;
  /// `a` and `b` have the same size, greys on a scale of 0 to 255; `out` is resized as needed. Same frames,
  /// same result.
  virtual void between(const GrayF& a, const GrayF& b, Flow& out) = 0;
  /// What the last pair took, such as {"iterations": 8, "converged": true}; empty when there is nothing to
  /// say.
  virtual Json effort() const { return Json::object(); }
};

/// What every flow part may use. Outlives the part.
struct FlowContext {
  Pool* pool;
};
using FlowRegistry = Registry<FlowMethod, FlowContext>;

}  // namespace faba
