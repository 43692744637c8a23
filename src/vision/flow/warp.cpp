#include "vision/flow/warp.h"

#include <cmath>
#include <limits>

namespace faba {
namespace {

template <class T>
struct CubicWeights {
  T w[4];
  explicit CubicWeights(T t)
      : w{T(0.5) * t * (t * (2 - t) - 1), T(0.5) * (t * t * (3 * t - 5) + 2),
          T(0.5) * t * (t * (4 - 3 * t) + 1), T(0.5) * t * t * (t - 1)} {}
};

}  // namespace

template <class T>
void warp(const Plane<T>& b, const FlowPlanes<T>& w, Plane<T>& out, Pool& pool) {
  out.resize(b.width(), b.height());
  const int last_col = b.width() - 1, last_row = b.height() - 1;
  for_rows(b.height(), pool, [&](int begin, int end) {
    for (int r = begin; r < end; ++r)
      for (int c = 0; c <= last_col; ++c) {
        const T x = T(c) + w.u.row(r)[c], y = T(r) + w.v.row(r)[c];
        if (!(x >= 0 && y >= 0 && x <= T(last_col) && y <= T(last_row))) {
          out.row(r)[c] = std::numeric_limits<T>::quiet_NaN();
          continue;
        }
        const int col = int(x), row = int(y);
        const CubicWeights<T> across(x - T(col)), along(y - T(row));
        T sum = 0;
        for (int j = 0; j < 4; ++j) {
          const T* p = b.row(std::clamp(row - 1 + j, 0, last_row));
          T line = 0;
          if (col >= 1 && col + 2 <= last_col) {
            for (int i = 0; i < 4; ++i) line += across.w[i] * p[col - 1 + i];
          } else {
            for (int i = 0; i < 4; ++i) line += across.w[i] * p[std::clamp(col - 1 + i, 0, last_col)];
          }
          sum += along.w[j] * line;
        }
        out.row(r)[c] = sum;
      }
  });
}

template void warp(const Plane<float>&, const FlowPlanes<float>&, Plane<float>&, Pool&);
template void warp(const Plane<double>&, const FlowPlanes<double>&, Plane<double>&, Pool&);

}  // namespace faba
