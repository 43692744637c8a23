#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "study/plot/plot.h"

/// The inside of plot_svg.cpp: colours, coordinates and the drawing of one layer. Include plot_svg.h instead.
namespace faba::drawing {

/// A colour by its class in the style sheet, on white and on a dark screen.
struct Shade {
  const char *name, *light, *dark;
};
inline constexpr Shade kPaper{"paper", "#ffffff", "#171b1f"}, kGrid{"grid", "#e3e6e9", "#2d3339"};
const Shade& shade(Ink ink);

/// Attributes that give a stroke, or a filling, this colour.
std::string stroke(const Shade& s);
std::string fill(const Shade& s);
/// The rules that make every Shade dark where the reader's system asks for it.
std::string style_sheet();

/// Height of the text, and the mean advance of a letter of a sans-serif font, in units of the figure.
inline constexpr double kText = 12, kTextWidth = 6.6;
/// Number of letters of a UTF-8 text, for guessing its width.
double letters(std::string_view text);

/// A place in the figure: x right, y down.
struct PlotPoint {
  double x, y;
};

/// A range of data, empty until a value was taken in. What is not finite, or so large that differences of it
/// would not be, is left out.
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

/// From data to the drawing area, whose upper left corner is (0, 0) and whose size is (w, h).
struct Map {
  Range x, y;
  bool flip_x = false, flip_y = false;
  double left = 0, top = 0, w = 0, h = 0;  ///< left and top: of the drawing area in the figure

  double to_x(double v) const;
  double to_y(double v) const;
};

/// A <text> element; `anchor` is start, middle or end, `more` further attributes.
std::string text_at(PlotPoint p, const char* anchor, const Shade& s, std::string_view words,
                    const char* more = "");
/// A <rect> element between two opposite corners.
std::string rectangle(const std::string& look, PlotPoint a, PlotPoint b);

/// What a layer needs of the axes, its drawing, and its sign in the legend around (0, 0) (empty: it has
/// none).
void layer_extent(const Plot::Layer& layer, Range& x, Range& y);
std::string layer_drawing(const Plot::Layer& layer, Ink ink, const Map& map);
std::string layer_swatch(const Plot::Layer& layer, Ink ink);

}  // namespace faba::drawing
