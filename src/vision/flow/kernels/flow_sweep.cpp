#include "vision/flow/kernels/flow_sweep.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/vectorised.h"
#include "core/wide.h"

namespace faba {
namespace {

constexpr int kTogether = 10;  // interleaved sweeps: their rows fit the second-level cache
constexpr int kStrip = 6;      // rows per strip of one sweep

/// Input and output rows of one sweep in a strip, including the rows above and below; every row is readable
/// one pixel beyond both ends.
template <class T>
struct Strip {
  struct Row {
    const T *u, *v;
    const T* c[5];  ///< coefficients: hx, hy, ht6 of the finest grid, or mxx, mxy, myy, cx, cy
    T *u_out, *v_out;
  };
  int rows = 0;  ///< rows of the strip: row[1] to row[rows]; row[0] is above, row[rows + 1] below
  Row row[kStrip + 2];
  int width = 0;
  bool finest = false;
};

/// `rows` is a compile-time constant, so that the row sums stay in registers.
template <int bytes, bool finest, int rows, class T>
[[gnu::always_inline]] inline void update(const Strip<T>& s) {
  using V = typename Wide<T, bytes>::type;
  constexpr int kLanes = bytes / int(sizeof(T));
  static_assert(Plane<T>::kMargin % kLanes == 0);  // full vectors are read and written at row ends
  const T half = T(0.5), sixth = T(1) / 6;
#define FABA_LANES(p) (*reinterpret_cast<const V*>((p) + x))
  for (int x = 0; x < s.width; x += kLanes) {
    // Six times the mean of the neighbours is the sum of the side neighbours plus, for the rows above and
    // below, the pixel there and half of its side neighbours. The sums `beside` and `row` are passed down the
    // rows, so each is computed once.
    V u_beside = FABA_LANES(s.row[0].u - 1) + FABA_LANES(s.row[0].u + 1);
    V v_beside = FABA_LANES(s.row[0].v - 1) + FABA_LANES(s.row[0].v + 1);
    V u_row_up = u_beside * half + FABA_LANES(s.row[0].u),
      v_row_up = v_beside * half + FABA_LANES(s.row[0].v);
    u_beside = FABA_LANES(s.row[1].u - 1) + FABA_LANES(s.row[1].u + 1);
    v_beside = FABA_LANES(s.row[1].v - 1) + FABA_LANES(s.row[1].v + 1);
    V u_row = u_beside * half + FABA_LANES(s.row[1].u), v_row = v_beside * half + FABA_LANES(s.row[1].v);
#pragma GCC unroll 8
    for (int i = 1; i <= rows; ++i) {
      const auto& here = s.row[i];
      const auto& below = s.row[i + 1];
      const V u_beside_down = FABA_LANES(below.u - 1) + FABA_LANES(below.u + 1);
      const V v_beside_down = FABA_LANES(below.v - 1) + FABA_LANES(below.v + 1);
      const V u_row_down = u_beside_down * half + FABA_LANES(below.u);
      const V v_row_down = v_beside_down * half + FABA_LANES(below.v);
      const V u = (u_row_up + u_row_down) + u_beside, v = (v_row_up + v_row_down) + v_beside;
      V &u_out = *reinterpret_cast<V*>(here.u_out + x), &v_out = *reinterpret_cast<V*>(here.v_out + x);
      if constexpr (finest) {
        const V hx = FABA_LANES(here.c[0]), hy = FABA_LANES(here.c[1]);
        const V along = (hx * u + FABA_LANES(here.c[2])) + hy * v;
        u_out = (u - hx * along) * sixth;
        v_out = (v - hy * along) * sixth;
      } else {
        const V mxy = FABA_LANES(here.c[1]);
        u_out = FABA_LANES(here.c[0]) * u + (mxy * v + FABA_LANES(here.c[3]));
        v_out = FABA_LANES(here.c[2]) * v + (mxy * u + FABA_LANES(here.c[4]));
      }
      u_beside = u_beside_down;
      u_row_up = u_row;
      u_row = u_row_down;
      v_beside = v_beside_down;
      v_row_up = v_row;
      v_row = v_row_down;
    }
  }
  for (int i = 1; i <= rows; ++i)
    for (T* out : {s.row[i].u_out, s.row[i].v_out}) {
      out[-1] = out[0];
      out[s.width] = out[s.width - 1];
    }
}
template <int bytes, int most = kStrip, class T>
[[gnu::always_inline]] inline void update_strip_in(const Strip<T>& s) {
  if (s.rows == most) return s.finest ? update<bytes, true, most>(s) : update<bytes, false, most>(s);
  if constexpr (most > 1) update_strip_in<bytes, most - 1>(s);
}
FABA_WIDE(update_strip, (const Strip<float>& s), (s))
FABA_WIDE(update_strip, (const Strip<double>& s), (s))

template <class T>
[[gnu::always_inline]] inline T largest(const T* a, const T* b, int n) {
  // Compilers vectorise the maxima of separate lanes, but not one maximum, whose order they must keep.
  constexpr int kLanes = 64;
  T of_lane[kLanes] = {};
  int x = 0;
  for (; x + kLanes <= n; x += kLanes)
    for (int k = 0; k < kLanes; ++k) {
      const T d = std::fabs(a[x + k] - b[x + k]);
      of_lane[k] = d > of_lane[k] ? d : of_lane[k];
    }
  for (int k = 0; x + k < n; ++k) {
    const T d = std::fabs(a[x + k] - b[x + k]);
    of_lane[k] = d > of_lane[k] ? d : of_lane[k];
  }
  T most = 0;
  for (const T m : of_lane) most = m > most ? m : most;
  return most;
}
FABA_VECTORISED float largest_change(const float* a, const float* b, int n) { return largest(a, b, n); }
FABA_VECTORISED double largest_change(const double* a, const double* b, int n) { return largest(a, b, n); }

constexpr int kRing = 8;  // rows of a sweep kept for the next sweep
static_assert(kRing >= kStrip + 2);

/// Row buffers between the sweeps of this thread, at least `width` px wide; kept, because allocation takes as
/// long as a sweep.
template <class T>
FlowPlanes<T>& rings(int width) {
  thread_local FlowPlanes<T> kept;
  if (kept.u.width() < width) kept.resize(width, kRing * (kTogether - 1));
  return kept;
}

/// Several interleaved sweeps over the rows [begin, end): sweep n runs one row and a strip behind sweep n -
/// 1, so that its input is still in the cache. Rows outside the band are computed as well where later sweeps
/// need them.
template <class T>
class Wavefront {
 public:
  Wavefront(const FlowSystem<T>& s, const FlowPlanes<T>& from, FlowPlanes<T>& to, int sweeps)
      : s_(s), from_(from), to_(to), sweeps_(sweeps), rings_(rings<T>(s.width())) {}

  T run(int begin, int end, bool watch) {
    T most = 0;
    const int height = s_.height();
    const int first = std::max(0, begin - sweeps_ + 1), last = std::min(height, end + sweeps_ - 1);
    for (int front = first; front < last + sweeps_ - 1; front += kStrip)
      for (int n = 1; n <= sweeps_; ++n) {
        const int low = std::max({0, begin - (sweeps_ - n), front - (n - 1)});
        const int high = std::min({height, end + (sweeps_ - n), front - (n - 1) + kStrip});
        if (low >= high) continue;
        strip(n, low, high);
        if (watch && n == sweeps_)
          for (int row = low; row < high; ++row)
            most = std::max({most, largest_change(to_.u.row(row), u(n - 1, row), s_.width()),
                             largest_change(to_.v.row(row), v(n - 1, row), s_.width())});
      }
    return most;
  }

 private:
  const T* u(int n, int row) const {
    return n == 0 ? from_.u.row(row) : rings_.u.row(kRing * (n - 1) + row % kRing);
  }
  const T* v(int n, int row) const {
    return n == 0 ? from_.v.row(row) : rings_.v.row(kRing * (n - 1) + row % kRing);
  }
  void strip(int n, int low, int high) {
    Strip<T> s;
    s.rows = high - low;
    s.width = s_.width();
    s.finest = s_.finest();
    for (int i = 0; i < s.rows + 2; ++i) {
      const int row = std::clamp(low - 1 + i, 0, s_.height() - 1);
      auto& r = s.row[i];
      r.u = u(n - 1, row);
      r.v = v(n - 1, row);
      if (s.finest) {
        r.c[0] = s_.hx.row(row);
        r.c[1] = s_.hy.row(row);
        r.c[2] = s_.ht6.row(row);
      } else {
        r.c[0] = s_.mxx.row(row);
        r.c[1] = s_.mxy.row(row);
        r.c[2] = s_.myy.row(row);
        r.c[3] = s_.cx.row(row);
        r.c[4] = s_.cy.row(row);
      }
      r.u_out = n == sweeps_ ? to_.u.row(row) : rings_.u.row(kRing * (n - 1) + row % kRing);
      r.v_out = n == sweeps_ ? to_.v.row(row) : rings_.v.row(kRing * (n - 1) + row % kRing);
    }
    update_strip(s);
  }

  const FlowSystem<T>& s_;
  const FlowPlanes<T>& from_;
  FlowPlanes<T>& to_;
  int sweeps_;
  FlowPlanes<T>& rings_;
};

}  // namespace

template <class T>
T sweep(const FlowSystem<T>& s, FlowPlanes<T>& w, FlowPlanes<T>& spare, int count, bool watch, Pool& pool) {
  T most = 0;
  std::mutex one;
  for (int r = 0; r < s.height(); ++r) w.extend(r);
  for (int done = 0; done < count;) {
    const int now = std::min(kTogether, count - done);
    done += now;
    const bool watch_now = watch && done == count;
    for_rows(s.height(), pool, [&](int begin, int end) {
      const T change = Wavefront<T>(s, w, spare, now).run(begin, end, watch_now);
      const std::lock_guard lock(one);
      most = std::max(most, change);
    });
    std::swap(w, spare);
  }
  return most;
}

template float sweep(const FlowSystem<float>&, FlowPlanes<float>&, FlowPlanes<float>&, int, bool, Pool&);
template double sweep(const FlowSystem<double>&, FlowPlanes<double>&, FlowPlanes<double>&, int, bool, Pool&);

}  // namespace faba
