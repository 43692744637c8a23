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

/// Optical flow of Horn and Schunck (1981) with the equations of theory A22. T is float, or double for high
/// precision. Reuses its memory between pairs. Deterministic and bit-identical for any pool.
template <class T>
class HornSchunck {
 public:
  HornSchunck(const HornSchunckParams& p, Pool& pool) : p_(p), pool_(pool) {}

  /// Flow from `a` to `b`: frames of the same size, grey values 0 to 255, whose margins are written. Valid
  /// until the next call.
  const FlowPlanes<T>& between(Plane<T>& a, Plane<T>& b);
  /// Sweeps (jacobi) or cycles (multigrid) on the finest grid for the last pair, summed over warps.
  int iterations() const { return done_; }
  /// Whether the last solution reached the tolerance within the iteration limit.
  bool converged() const { return converged_; }

 private:
  struct Level {
    Plane<T> a, b;
  };
  void solve(Plane<T>& a, Plane<T>& b, bool warped);
  void coarse_to_fine();

  HornSchunckParams p_;
  Pool& pool_;
  std::vector<Level> levels_;  ///< from fine to coarse; for smoothed frames or a pyramid
  Plane<T> warped_;
  FlowDerivatives<T> derivatives_;
  FlowSystem<T> system_;
  FlowMultigrid<T> multigrid_;
  FlowPlanes<T> w_, spare_;
  int done_ = 0;
  bool converged_ = false;
};

}  // namespace faba
