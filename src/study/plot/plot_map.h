#pragma once
#include <cmath>
#include <limits>

namespace faba::drawing {

/// Largest coordinate of a drawing: renderers lose precision at larger ones.
inline constexpr double kMaxCoordinate = 1e5;

/// A point of the figure: x right, y down.
struct PlotPoint {
  double x, y;
  int index = -1;  ///< in the data of its layer
};

/// A range of data, initially empty. Ignores non-finite values and values whose differences could overflow.
struct Range {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  void take(double v) {
    if (!(std::abs(v) < 1e100)) return;
    if (v < lo) lo = v;
    if (v > hi) hi = v;
  }
  bool empty() const { return lo > hi; }
  double length() const { return hi - lo; }
};

/// Transforms data to coordinates of the drawing area, with upper left corner (0, 0) and size (w, h).
struct Map {
  Range x, y;
  bool flip_x = false, flip_y = false;
  double left = 0, top = 0, w = 0, h = 0;  ///< left and top: of the drawing area in the figure

  double to_x(double v) const;
  double to_y(double v) const;
};

}  // namespace faba::drawing
