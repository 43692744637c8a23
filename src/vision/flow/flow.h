#pragma once
#include <memory>
#include <optional>

#include "core/registry.h"
#include "core/threads/parallel.h"
#include "vision/image/image.h"

namespace faba {

/// Displacement field between two frames: u to the right, v down (image frame), px per frame pair.
struct Flow {
  GrayF u, v;
  int width() const { return u.width; }
  int height() const { return u.height; }
};

/// Iterations of an iterative method for one frame pair.
struct FlowEffort {
  int iterations = 0;
  bool converged = false;  ///< false: the iteration limit was reached
};

/// Method that computes the optical flow between two frames. Reuses its memory from pair to pair: not
/// thread-safe.
class FlowMethod {
 public:
  virtual ~FlowMethod() = default;
  /// Computes the flow from `a` to `b`: frames of the same size, grey values 0 to 255; `out` is resized as
  /// needed. Deterministic.
  virtual void between(const GrayF& a, const GrayF& b, Flow& out) = 0;
  /// Iterations for the last pair; empty for a method that does not iterate.
  virtual std::optional<FlowEffort> effort() const { return {}; }
};

/// Context of flow parts. Outlives the part.
struct FlowContext {
  Pool* pool;
};
using FlowRegistry = Registry<FlowMethod, FlowContext>;

}  // namespace faba
