#pragma once
#include <vector>

#include "core/schema.h"
#include "vision/flow/flow.h"
#include "vision/flow/flow_multigrid.h"

namespace faba {

enum class FlowSolver { multigrid, jacobi };

/// Parameters of Horn and Schunck's optical flow.
struct HornSchunckParams {
  double alpha2 = 100;
  FlowSolver solver = FlowSolver::multigrid;
  int iterations = 100;
  double tolerance = 1e-3;
  double smooth = 0;
  bool pyramid = false;
  int warps = 3;
  static Schema<HornSchunckParams> schema();
};

/// Optical flow after Horn and Schunck (1981) with the equations of theory A22. T is float, or double where
/// the last digits are wanted. Keeps its memory from pair to pair. Same frames, same bits, for any pool.
template <class T>
class HornSchunck {
 public:
  HornSchunck(const HornSchunckParams& p, Pool& pool) : p_(p), pool_(pool) {}

  /// The flow from `a` to `b`, frames of one size with greys of 0 to 255; valid until the next call.
  const FlowPlanes<T>& between(const Plane<T>& a, const Plane<T>& b);
  /// Sweeps (jacobi) or cycles (multigrid) on the finest grid for the last pair, warps added up.
  int iterations() const { return done_; }
  /// Whether the last solution came within the tolerance before the iterations were used up.
  bool converged() const { return converged_; }

 private:
  struct Level {
    Plane<T> a, b;
  };
  void solve(Plane<T>& a, Plane<T>& b, bool warped);
  void coarse_to_fine();

  HornSchunckParams p_;
  Pool& pool_;
  std::vector<Level> levels_;  ///< from the finest one up
  Plane<T> warped_;
  FlowDerivatives<T> derivatives_;
  FlowSystem<T> system_;
  FlowMultigrid<T> multigrid_;
  FlowPlanes<T> w_, spare_;
  int done_ = 0;
  bool converged_ = false;
};

}  // namespace faba
