#include "vision/flow/flow_multigrid.h"

#include "vision/flow/kernels/flow_sweep.h"

namespace faba {
namespace {

constexpr int kPreSmoothing = 2, kPostSmoothing = 2;  // sweeps
constexpr int kCoarsest = 3;                          // px, the larger side
constexpr int kCoarsestSweeps = 12;  // sweeps on the coarsest grid; each reduces the error to a third or less

}  // namespace

template <class T>
void FlowMultigrid<T>::set_up(const FlowSystem<T>& finest, Pool& pool) {
  std::size_t grids = 0;
  for (int n = std::max(finest.width(), finest.height()); n > kCoarsest; n = (n + 1) / 2) ++grids;
  coarser_.resize(grids);
  const FlowSystem<T>* finer = &finest;
  for (Grid& g : coarser_) {
    g.system.set_up_coarser_than(*finer, pool);
    g.w.resize(g.system.width(), g.system.height());
    g.spare.resize(g.system.width(), g.system.height());
    finer = &g.system;
  }
}

template <class T>
void FlowMultigrid<T>::guess(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare,
                             Pool& pool) {
  const FlowSystem<T>* finer = &finest;
  for (Grid& g : coarser_) {
    restrict_right_side(*finer, g.system, pool);
    finer = &g.system;
  }
  // A cycle overwrites the right-hand sides of the coarser grids; they are no longer needed by then.
  for (std::size_t i = coarser_.size(); i-- > 0;) {
    Grid& g = coarser_[i];
    g.system.set_up_right_side(pool);
    g.w.clear();
    if (i + 1 < coarser_.size()) prolong_and_add(coarser_[i + 1].w, g.w, pool);
    cycle(i + 1, g.system, g.w, g.spare, pool);
  }
  w.clear();
  if (!coarser_.empty()) prolong_and_add(coarser_[0].w, w, pool);
  sweep(finest, w, spare, kPostSmoothing, false, pool);
}

template <class T>
T FlowMultigrid<T>::cycle(const FlowSystem<T>& finest, FlowPlanes<T>& w, FlowPlanes<T>& spare, Pool& pool) {
  return cycle(0, finest, w, spare, pool);
}

template <class T>
T FlowMultigrid<T>::cycle(std::size_t below, const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare,
                          Pool& pool) {
  if (below == coarser_.size()) return sweep(s, w, spare, kCoarsestSweeps, true, pool);
  Grid& g = coarser_[below];
  sweep(s, w, spare, kPreSmoothing, false, pool);
  restrict_residual(s, w, g.system, pool);
  g.system.set_up_right_side(pool);
  g.w.clear();
  cycle(below + 1, g.system, g.w, g.spare, pool);
  const T correction = prolong_and_add(g.w, w, pool);
  return std::max(correction, sweep(s, w, spare, kPostSmoothing, true, pool));
}

template class FlowMultigrid<float>;
template class FlowMultigrid<double>;

}  // namespace faba
