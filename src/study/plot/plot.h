#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace faba {

/// Colours of the layers, after Okabe and Ito (Color Universal Design, 2008), distinguishable with common
/// colour vision deficiencies. Dark mode exchanges blue with sky and vermillion with orange for contrast.
/// `automatic`: next colour not used for an automatic layer of this plot.
enum class Ink { automatic, blue, vermillion, green, purple, orange, sky, text, muted };

/// A curve through (x[i], y[i]) in the units of the axes. Non-finite points leave a gap. Long curves are
/// thinned to the screen resolution; the minimum and maximum of every pixel column are kept.
struct Line {
  std::vector<double> x, y;  ///< equal length; a longer one is truncated
  std::string label = {};    ///< legend entry; none when empty
  Ink ink = Ink::automatic;
  bool dashed = false;
  bool stairs = false;  ///< each value is constant until the next x, as a command
  double width = 1.7;   ///< in units of the figure
};

/// Unconnected points.
struct Scatter {
  enum class Mark { dot, ring, cross };
  std::vector<double> x, y;  ///< equal length; non-finite points are omitted
  std::string label = {};
  Ink ink = Ink::automatic;
  Mark mark = Mark::dot;
  double size = 5;  ///< diameter in units of the figure
};

/// A shaded range of one axis, over the full length of the other.
struct Band {
  double lo = 0, hi = 0;
  std::string label = {};
  bool of_x = false;  ///< range of x (a time interval); otherwise of y
  Ink ink = Ink::muted;
};

/// The area between two curves over the same x, for example a range or an error band.
struct Ribbon {
  std::vector<double> x, lo, hi;  ///< equal length; a longer one is truncated; non-finite points leave a gap
  std::string label = {};
  Ink ink = Ink::automatic;
};

/// A vertical bar with caps from lo to hi at each x: an interval or a standard error.
struct ErrorBars {
  std::vector<double> x, lo, hi;  ///< equal length; non-finite ones are omitted
  std::string label = {};
  Ink ink = Ink::automatic;
};

/// A thin straight line across the plot at one value, with its label beside it.
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

/// Where the ticks of an axis are: at round numbers; at integers, for counts and numbers of frames; or
/// at multiples of 45 degrees, or of a divisor of 45 for a small range of angles.
enum class Ticks { numbers, integers, degrees };

struct PlotAxis {
  std::string label = {};        ///< quantity and unit: "time (s)"
  std::optional<double> lo, hi;  ///< limits of the range, finite; empty: from the data
  Ticks ticks = Ticks::numbers;
  bool reversed = false;  ///< small values right or on top, as the rows of a picture
  /// Logarithmic scale: values that are not positive are omitted; lo and hi must be positive. Cannot be
  /// combined with equal_aspect or a second scale.
  bool logarithmic = false;
};

/// A second y axis at the right: the same curves in another unit, or a curve that is drawn in units of this
/// axis. Its value at y of the left axis is per_unit * y + offset.
struct SecondScale {
  double per_unit = 1;
  std::string label = {};
  double offset = 0;
};

/// A plot: layers in drawing order, and axes. To add a kind of layer, add a struct to `Layer` and its
/// extent(), draw() and swatch() in plot_layers.cpp.
struct Plot {
  using Layer = std::variant<Line, Scatter, Band, Ribbon, ErrorBars, Rule, Ellipse, Box>;

  std::string title = {};        ///< above the plot; may be empty
  std::string description = {};  ///< text for screen readers; empty: the title
  PlotAxis x = {}, y = {};
  std::optional<SecondScale> right = {};
  bool equal_aspect = false;  ///< equal units in x and y; the height follows from the ranges
  double width = 460;         ///< in figure units; the text height is 12
  double height = 270;        ///< without legend and title; ignored with equal_aspect
  bool inlined = false;       ///< for the body of an HTML page: without XML namespace
  std::vector<Layer> layers = {};

  /// Adds a layer on top: `plot.add(Band{...}).add(Line{...})`.
  template <class AnyLayer>
  Plot& add(AnyLayer layer) {
    layers.emplace_back(std::move(layer));
    return *this;
  }
};

}  // namespace faba
