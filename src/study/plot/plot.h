#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace faba {

/// Colours of the layers, after Okabe and Ito (Color Universal Design, 2008): told apart with any common
/// colour vision. In dark mode blue and sky, vermillion and orange change places, so that the first ones keep
/// their contrast. `automatic` takes the next colour that this plot has not used for an automatic layer.
enum class Ink { automatic, blue, vermillion, green, purple, orange, sky, text, muted };

/// A curve through (x[i], y[i]) in the units of the axes. Non-finite points leave a gap. Any number of
/// points: what is finer than the screen is dropped, except the minimum and maximum of every pixel column.
struct Line {
  std::vector<double> x, y;  ///< same length; what is longer is cut
  std::string label = {};    ///< legend entry; none when empty
  Ink ink = Ink::automatic;
  bool dashed = false;
  bool held = false;   ///< each value holds until the next x (a staircase), as a command does
  double width = 1.7;  ///< in units of the figure
};

/// Points without connection.
struct Scatter {
  enum class Mark { dot, ring, cross };
  std::vector<double> x, y;  ///< same length; non-finite points are left out
  std::string label = {};
  Ink ink = Ink::automatic;
  Mark mark = Mark::dot;
  double size = 5;  ///< diameter in units of the figure
};

/// A shaded range of one axis, over the whole length of the other.
struct Band {
  double lo = 0, hi = 0;
  std::string label = {};
  bool of_x = false;  ///< the range is of x (a time span); otherwise of y
  Ink ink = Ink::muted;
};

/// The area between two curves over the same x: how far something goes up and down.
struct Ribbon {
  std::vector<double> x, lo, hi;  ///< same length; what is longer is cut; non-finite points are left out
  std::string label = {};
  Ink ink = Ink::automatic;
};

/// A thin straight line across the plot at one value, with its words beside it.
struct Rule {
  double at = 0;
  std::string label = {};
  bool of_x = true;  ///< at this x (vertical); otherwise at this y
  Ink ink = Ink::muted;
};

/// The outline of an ellipse, or of a circle when both radii are equal.
struct Ellipse {
  double x = 0, y = 0, radius_x = 0, radius_y = 0;
  std::string label = {};
  Ink ink = Ink::muted;
  bool dashed = false;
};

/// The outline of a rectangle with sides along the axes.
struct Box {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::string label = {};
  Ink ink = Ink::muted;
  bool dashed = false;
};

struct PlotAxis {
  std::string label = {};        ///< quantity and unit: "time (s)"
  std::optional<double> lo, hi;  ///< ends of the range; from the data when empty; must be finite
  bool reversed = false;         ///< small values at the right or on top, as the rows of a picture
  /// Equal ratios are equally long; values that are not positive are left out, and lo and hi must be
  /// positive. Not together with equal_aspect or a second scale.
  bool logarithmic = false;
};

/// A second scale at the right, for the same curves in another unit.
struct SecondScale {
  double per_unit = 1;  ///< its value where the left scale says 1
  std::string label = {};
};

/// A figure: what is drawn, in this order, and its axes. A value: fill it in, copy it, pass it to svg().
/// To give it another kind of layer, add a struct to `Layer` and its extent(), draw() and swatch() in
/// plot_layers.cpp.
struct Plot {
  using Layer = std::variant<Line, Scatter, Band, Ribbon, Rule, Ellipse, Box>;

  std::string title = {};        ///< drawn on top; may be empty
  std::string description = {};  ///< read out by screen readers instead of the picture; the title when empty
  PlotAxis x = {}, y = {};
  std::optional<SecondScale> right = {};
  bool equal_aspect = false;  ///< one unit is as long in x as in y; the height follows from the ranges
  double width = 460;         ///< of the drawing, in its own units; text is 12 of them high
  double height = 270;        ///< without legend and title, which come on top; ignored with equal_aspect
  bool inlined = false;       ///< for the body of an HTML page: leaves out the XML namespace
  std::vector<Layer> layers = {};

  /// Appends a layer on top: `plot.add(Band{...}).add(Line{...})`.
  template <class AnyLayer>
  Plot& add(AnyLayer layer) {
    layers.emplace_back(std::move(layer));
    return *this;
  }
};

}  // namespace faba
