#include "vision/flow/kernels/flow_system.h"

#include <cmath>
#include <mutex>

#include "core/vectorised.h"

namespace faba {
namespace {

// Row kernels. The templates are instantiated by the functions below for float and double and for every
// instruction set.

template <class T>
struct DerivativeRow {
  const T *a, *a_down, *b, *b_down;
  T *ix, *iy, *it;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const DerivativeRow<T>& r) {
  const T *a = r.a, *a_down = r.a_down, *b = r.b, *b_down = r.b_down;
  T *ix = r.ix, *iy = r.iy, *it = r.it;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T a0 = a[x], a1 = a[x + 1], a2 = a_down[x], a3 = a_down[x + 1];
    const T b0 = b[x], b1 = b[x + 1], b2 = b_down[x], b3 = b_down[x + 1];
    ix[x] = (((a1 - a0) + (a3 - a2)) + ((b1 - b0) + (b3 - b2))) * T(0.25);
    iy[x] = (((a2 - a0) + (a3 - a1)) + ((b2 - b0) + (b3 - b1))) * T(0.25);
    it[x] = (((b0 - a0) + (b1 - a1)) + ((b2 - a2) + (b3 - a3))) * T(0.25);
  }
}

/// Coefficients of the published iteration.
template <class T>
struct PublishedRow {
  const T *ix, *iy, *it;
  const T *u, *v;  ///< flow by which the second frame was warped
  T *hx, *hy, *ht6;
  T lambda;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const PublishedRow<T>& r) {
  const T *ix = r.ix, *iy = r.iy, *it = r.it, *u = r.u, *v = r.v;
  T *hx = r.hx, *hy = r.hy, *ht6 = r.ht6;
  const T lambda = r.lambda;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T gx = ix[x], gy = iy[x], gt = it[x] - (gx * u[x] + gy * v[x]);
    const T scale = 1 / std::sqrt(lambda + (gx * gx + gy * gy));
    hx[x] = gx * scale;
    hy[x] = gy * scale;
    ht6[x] = 6 * gt * scale;
  }
}

template <class T>
struct DataRow {
  const T *ix, *iy, *it;
  const T *u, *v;  ///< as above
  T *jxx, *jxy, *jyy, *fx, *fy;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const DataRow<T>& r) {
  const T *ix = r.ix, *iy = r.iy, *it = r.it, *u = r.u, *v = r.v;
  T *jxx = r.jxx, *jxy = r.jxy, *jyy = r.jyy, *fx = r.fx, *fy = r.fy;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T gx = ix[x], gy = iy[x], gt = it[x] - (gx * u[x] + gy * v[x]);
    jxx[x] = gx * gx;
    jxy[x] = gx * gy;
    jyy[x] = gy * gy;
    fx[x] = -(gx * gt);
    fy[x] = -(gy * gt);
  }
}

template <class T>
struct UpdateRow {
  const T *jxx, *jxy, *jyy;
  T *mxx, *mxy, *myy;
  T lambda;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const UpdateRow<T>& r) {
  const T *jxx = r.jxx, *jxy = r.jxy, *jyy = r.jyy;
  T *mxx = r.mxx, *mxy = r.mxy, *myy = r.myy;
  const T lambda = r.lambda;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T xx = lambda + jxx[x], yy = lambda + jyy[x], xy = jxy[x];
    const T scale = lambda / ((xx * yy - xy * xy) * 6);
    mxx[x] = scale * yy;
    mxy[x] = -scale * xy;
    myy[x] = scale * xx;
  }
}

template <class T>
struct RightSideRow {
  const T *mxx, *mxy, *myy, *fx, *fy;
  T *cx, *cy;
  T by_lambda;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const RightSideRow<T>& r) {
  const T *mxx = r.mxx, *mxy = r.mxy, *myy = r.myy, *fx = r.fx, *fy = r.fy;
  T *cx = r.cx, *cy = r.cy;
  const T scale = 6 * r.by_lambda;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T gx = fx[x] * scale, gy = fy[x] * scale;
    cx[x] = mxx[x] * gx + mxy[x] * gy;
    cy[x] = mxy[x] * gx + myy[x] * gy;
  }
}

template <class T>
struct ResidualRow {
  const T *u_up, *u, *u_down, *v_up, *v, *v_down;
  const T *jxx, *jxy, *jyy, *fx, *fy;
  T *rx, *ry;
  T lambda;
  int width;
};
template <class T>
[[gnu::always_inline]] inline void row(const ResidualRow<T>& r) {
  const T *uu = r.u_up, *u = r.u, *ud = r.u_down, *vu = r.v_up, *v = r.v, *vd = r.v_down;
  const T *jxx = r.jxx, *jxy = r.jxy, *jyy = r.jyy, *fx = r.fx, *fy = r.fy;
  T *rx = r.rx, *ry = r.ry;
  const T lambda = r.lambda, twelfth = T(1) / 12;
  FABA_ELEMENTWISE
  for (int x = 0; x < r.width; ++x) {
    const T u_side = (u[x - 1] + u[x + 1]) + (uu[x] + ud[x]),
            v_side = (v[x - 1] + v[x + 1]) + (vu[x] + vd[x]);
    const T u_far = (uu[x - 1] + uu[x + 1]) + (ud[x - 1] + ud[x + 1]);
    const T v_far = (vu[x - 1] + vu[x + 1]) + (vd[x - 1] + vd[x + 1]);
    const T u_mean = (u_far + 2 * u_side) * twelfth, v_mean = (v_far + 2 * v_side) * twelfth;
    rx[x] = lambda * (u_mean - u[x]) - (jxx[x] * u[x] + jxy[x] * v[x]) + fx[x];
    ry[x] = lambda * (v_mean - v[x]) - (jxy[x] * u[x] + jyy[x] * v[x]) + fy[x];
  }
}

/// Mean of two rows over pairs of pixels. A missing pixel at the border counts as zero: the mean is an
/// integral over an area, and a coarse pixel that is only half inside the fine grid has half of it.
template <class T>
struct RestrictRow {
  const T *a, *b;
  T* out;
  int width;  ///< of a and b
};
template <class T>
[[gnu::always_inline]] inline void row(const RestrictRow<T>& r) {
  const T *a = r.a, *b = r.b;
  T* out = r.out;
  const std::ptrdiff_t pairs = r.width / 2;
  FABA_ELEMENTWISE
  for (std::ptrdiff_t x = 0; x < pairs; ++x)
    out[x] = ((a[2 * x] + a[2 * x + 1]) + (b[2 * x] + b[2 * x + 1])) * T(0.25);
  if (r.width % 2) out[pairs] = (a[2 * pairs] + b[2 * pairs]) * T(0.25);
}

/// Linear interpolation: 3/4 of the coarse row that contains the fine row, 1/4 of the next nearest one.
template <class T>
struct ProlongRow {
  const T *near, *far;
  T *mixed, *out;  ///< mixed: scratch
  int width;       ///< of out
  T most;          ///< largest value added
};
template <class T>
[[gnu::always_inline]] inline void row(ProlongRow<T>& r) {
  const T *near = r.near, *far = r.far;
  T *mixed = r.mixed, *out = r.out;
  const int coarse = (r.width + 1) / 2;
  FABA_ELEMENTWISE
  for (int x = -1; x <= coarse; ++x) mixed[x] = near[x] * T(0.75) + far[x] * T(0.25);
  T most = r.most;
  for (std::ptrdiff_t x = 0; x < r.width / 2; ++x) {
    const T left = mixed[x] * T(0.75) + mixed[x - 1] * T(0.25);
    const T right = mixed[x] * T(0.75) + mixed[x + 1] * T(0.25);
    out[2 * x] += left;
    out[2 * x + 1] += right;
    const T a = std::fabs(left), b = std::fabs(right), larger = a > b ? a : b;
    most = larger > most ? larger : most;
  }
  if (r.width % 2) out[r.width - 1] += mixed[coarse - 1] * T(0.75) + mixed[coarse - 2] * T(0.25);
  r.most = most;
}

#define FABA_ROWS(type)                                                 \
  FABA_VECTORISED void do_row(const DerivativeRow<type>& r) { row(r); } \
  FABA_VECTORISED void do_row(const PublishedRow<type>& r) { row(r); }  \
  FABA_VECTORISED void do_row(const DataRow<type>& r) { row(r); }       \
  FABA_VECTORISED void do_row(const UpdateRow<type>& r) { row(r); }     \
  FABA_VECTORISED void do_row(const RightSideRow<type>& r) { row(r); }  \
  FABA_VECTORISED void do_row(const ResidualRow<type>& r) { row(r); }   \
  FABA_VECTORISED void do_row(const RestrictRow<type>& r) { row(r); }   \
  FABA_VECTORISED void do_row(ProlongRow<type>& r) { row(r); }
FABA_ROWS(float)
FABA_ROWS(double)
#undef FABA_ROWS

template <class T>
void restrict_plane(const Plane<T>& fine, Plane<T>& coarse, Pool& pool) {
  const Plane<T> none(fine.width(), 1);
  for_rows(coarse.height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r)
      do_row(RestrictRow<T>{fine.row(2 * r), 2 * r + 1 < fine.height() ? fine.row(2 * r + 1) : none.row(0),
                            coarse.row(r), fine.width()});
  });
}

template <class T>
T prolong_plane(Plane<T>& coarse, Plane<T>& fine, Pool& pool) {
  std::mutex one;
  T most = 0;
  for (int r = 0; r < coarse.height(); ++r) coarse.extend(r);
  for_rows(fine.height(), pool, [&](int begin, int end) {
    Plane<T> mixed(coarse.width(), 1);
    ProlongRow<T> job{nullptr, nullptr, mixed.row(0), nullptr, fine.width(), 0};
    for (int r = begin; r < end; ++r) {
      const int near = r / 2, far = std::clamp(r % 2 ? near + 1 : near - 1, 0, coarse.height() - 1);
      job.near = coarse.row(near);
      job.far = coarse.row(far);
      job.out = fine.row(r);
      do_row(job);
    }
    const std::lock_guard lock(one);
    most = std::max(most, job.most);
  });
  return most;
}

}  // namespace

template <class T>
void differentiate(Plane<T>& a, Plane<T>& b, FlowDerivatives<T>& out, Pool& pool) {
  out.resize(a.width(), a.height());
  for (int r = 0; r < a.height(); ++r) {
    a.extend(r);
    b.extend(r);
  }
  for_rows(a.height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      const int down = std::min(r + 1, a.height() - 1);
      do_row(DerivativeRow<T>{a.row(r), a.row(down), b.row(r), b.row(down), out.ix.row(r), out.iy.row(r),
                              out.it.row(r), a.width()});
    }
  });
}

template <class T>
void FlowSystem<T>::resize_data_term(int width, int height) {
  for (Plane<T>* p : {&jxx, &jxy, &jyy, &fx, &fy}) p->resize(width, height);
}

template <class T>
void FlowSystem<T>::set_up(const FlowDerivatives<T>& d, const FlowPlanes<T>* around, bool data_term,
                           Pool& pool) {
  for (Plane<T>* p : {&hx, &hy, &ht6}) p->resize(d.ix.width(), d.ix.height());
  if (data_term) resize_data_term(width(), height());
  const Plane<T> none(around ? 0 : width(), 1);
  for_rows(height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      const T *ix = d.ix.row(r), *iy = d.iy.row(r), *it = d.it.row(r);
      const T *u = around ? around->u.row(r) : none.row(0), *v = around ? around->v.row(r) : none.row(0);
      do_row(PublishedRow<T>{ix, iy, it, u, v, hx.row(r), hy.row(r), ht6.row(r), lambda, width()});
      if (data_term)
        do_row(
            DataRow<T>{ix, iy, it, u, v, jxx.row(r), jxy.row(r), jyy.row(r), fx.row(r), fy.row(r), width()});
    }
  });
}

template <class T>
void FlowSystem<T>::set_up_coarser_than(const FlowSystem& fine, Pool& pool) {
  const int w = (fine.width() + 1) / 2, h = (fine.height() + 1) / 2;
  for (Plane<T>* p : {&mxx, &mxy, &myy, &cx, &cy}) p->resize(w, h);
  resize_data_term(w, h);
  lambda = fine.lambda / 4;
  restrict_plane(fine.jxx, jxx, pool);
  restrict_plane(fine.jxy, jxy, pool);
  restrict_plane(fine.jyy, jyy, pool);
  for_rows(height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r)
      do_row(UpdateRow<T>{jxx.row(r), jxy.row(r), jyy.row(r), mxx.row(r), mxy.row(r), myy.row(r), lambda,
                          width()});
  });
}

template <class T>
void FlowSystem<T>::set_up_right_side(Pool& pool) {
  for_rows(height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r)
      do_row(RightSideRow<T>{mxx.row(r), mxy.row(r), myy.row(r), fx.row(r), fy.row(r), cx.row(r), cy.row(r),
                             1 / lambda, width()});
  });
}

template <class T>
void restrict_residual(const FlowSystem<T>& s, FlowPlanes<T>& w, FlowSystem<T>& coarse, Pool& pool) {
  for (int r = 0; r < s.height(); ++r) w.extend(r);
  for_rows(coarse.height(), pool, [&](int begin, int end) {
    Plane<T> rx(s.width(), 2), ry(s.width(), 2);
    for (int half = begin; half < end; ++half) {
      for (int i = 0; i < 2; ++i) {
        const int r = 2 * half + i;
        if (r == s.height()) {
          rx.clear_row(i);
          ry.clear_row(i);
          continue;
        }
        const int up = std::max(r - 1, 0), down = std::min(r + 1, s.height() - 1);
        do_row(ResidualRow<T>{w.u.row(up), w.u.row(r), w.u.row(down), w.v.row(up), w.v.row(r), w.v.row(down),
                              s.jxx.row(r), s.jxy.row(r), s.jyy.row(r), s.fx.row(r), s.fy.row(r), rx.row(i),
                              ry.row(i), s.lambda, s.width()});
      }
      do_row(RestrictRow<T>{rx.row(0), rx.row(1), coarse.fx.row(half), s.width()});
      do_row(RestrictRow<T>{ry.row(0), ry.row(1), coarse.fy.row(half), s.width()});
    }
  });
}

template <class T>
void restrict_right_side(const FlowSystem<T>& s, FlowSystem<T>& coarse, Pool& pool) {
  restrict_plane(s.fx, coarse.fx, pool);
  restrict_plane(s.fy, coarse.fy, pool);
}

template <class T>
T prolong_and_add(FlowPlanes<T>& coarse, FlowPlanes<T>& w, Pool& pool) {
  const T u = prolong_plane(coarse.u, w.u, pool), v = prolong_plane(coarse.v, w.v, pool);
  return std::max(u, v);
}

#define FABA_FLOW(T)                                                                            \
  template struct FlowSystem<T>;                                                                \
  template void differentiate(Plane<T>&, Plane<T>&, FlowDerivatives<T>&, Pool&);                \
  template void restrict_residual(const FlowSystem<T>&, FlowPlanes<T>&, FlowSystem<T>&, Pool&); \
  template void restrict_right_side(const FlowSystem<T>&, FlowSystem<T>&, Pool&);               \
  template T prolong_and_add(FlowPlanes<T>&, FlowPlanes<T>&, Pool&);
FABA_FLOW(float)
FABA_FLOW(double)
#undef FABA_FLOW

}  // namespace faba
