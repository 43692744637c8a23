#pragma once
#include "core/threads/parallel.h"
#include "vision/image/plane.h"

namespace faba {

/// A flow on padded planes, px. T is float or double here and below.
template <class T>
struct FlowPlanes {
  Plane<T> u, v;
  void resize(int width, int height) {
    u.resize(width, height);
    v.resize(width, height);
  }
  void clear() {
    u.clear();
    v.clear();
  }
  void extend(int row) {
    u.extend(row);
    v.extend(row);
  }
};

/// First differences of a frame pair, each the mean of four over a cube of 2 x 2 pixels and both frames,
/// located between these pixels, as published. Grey levels per px and per frame.
template <class T>
struct FlowDerivatives {
  Plane<T> ix, iy, it;
  void resize(int width, int height) {
    ix.resize(width, height);
    iy.resize(width, height);
    it.resize(width, height);
  }
};
/// The frames have the same size; beyond the border their pixels are repeated (margins are written to).
template <class T>
void differentiate(Plane<T>& a, Plane<T>& b, FlowDerivatives<T>& out, Pool& pool);

/// The equations of Horn and Schunck for a flow w = (u, v) on one grid (theory A22): lambda (w - K w) + J w =
/// f, where K is the mean over the eight neighbours (weights 1/6 for side neighbours, 1/12 for diagonal ones,
/// border repeated), J = grad I grad I^T and f = -grad I It. Solving at one pixel with fixed neighbours gives
/// the iteration. On the finest grid J has rank one and the iteration is the published one, w <- K w - h (h .
/// K w + ht) with (h, ht) = (grad I, It) / sqrt(lambda + |grad I|^2); on coarser grids it is w <- M K w + c.
template <class T>
struct FlowSystem {
  T lambda = 0;            ///< weight of smoothness, grey levels^2
  Plane<T> hx, hy, ht6;    ///< finest grid: h and 6 ht
  Plane<T> mxx, mxy, myy;  ///< coarser grids: M / 6, M = lambda (lambda + J)^-1
  Plane<T> cx, cy;         ///< coarser grids: (lambda + J)^-1 f
  Plane<T> jxx, jxy, jyy;  ///< data term
  Plane<T> fx, fy;         ///< right-hand side

  bool finest() const { return hx.width() > 0; }
  int width() const { return finest() ? hx.width() : cx.width(); }
  int height() const { return finest() ? hx.height() : cx.height(); }
  /// Sets up the finest grid: h from the derivatives and, with `data_term`, J and f, which only coarser grids
  /// need. With `around` (the flow by which the second frame was warped) the unknown is still the total flow.
  void set_up(const FlowDerivatives<T>& d, const FlowPlanes<T>* around, bool data_term, Pool& pool);
  /// Sets up J (averaged from the next finer grid) and M; lambda is a quarter because pixels are twice as
  /// large.
  void set_up_coarser_than(const FlowSystem& fine, Pool& pool);
  /// Computes c from f.
  void set_up_right_side(Pool& pool);

 private:
  void resize_data_term(int width, int height);
};

/// Restricts the residual f - A w (mean over 2 x 2 pixels) to the right-hand side f of the next coarser grid.
template <class T>
void restrict_residual(const FlowSystem<T>& s, FlowPlanes<T>& w, FlowSystem<T>& coarse, Pool& pool);
/// Restricts f (mean over 2 x 2 pixels) to the next coarser grid.
template <class T>
void restrict_right_side(const FlowSystem<T>& s, FlowSystem<T>& coarse, Pool& pool);
/// Prolongs the flow of the next coarser grid by linear interpolation and adds it to `w`. Returns the largest
/// component added.
template <class T>
T prolong_and_add(FlowPlanes<T>& coarse, FlowPlanes<T>& w, Pool& pool);

}  // namespace faba
