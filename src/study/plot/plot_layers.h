#pragma once
#include <string>
#include <string_view>

#include "study/plot/plot.h"
#include "study/plot/plot_map.h"

/// Implementation details of plot_svg.cpp: colours, coordinates and the drawing of one layer. Include
/// plot_svg.h instead.
namespace faba::drawing {

/// A colour: class in the style sheet, value in light mode and in dark mode.
struct Shade {
  const char *name, *light, *dark;
};
inline constexpr Shade kPaper{"paper", "#ffffff", "#171b1f"}, kGrid{"grid", "#e3e6e9", "#2d3339"};
const Shade& shade(Ink ink);

/// Attributes for a stroke or a fill of this colour.
std::string stroke(const Shade& s);
std::string fill(const Shade& s);
/// CSS rules with the dark-mode value of every Shade.
std::string style_sheet();

/// Text height, and mean advance of a character of a sans-serif font, in figure units.
inline constexpr double kText = 12, kTextWidth = 6.6;
/// Number of characters of a UTF-8 text, to estimate its width.
double character_count(std::string_view text);

/// A <text> element; `anchor` is start, middle or end, `more` further attributes.
std::string text_at(PlotPoint p, const char* anchor, const Shade& s, std::string_view text,
                    const char* more = "");
/// A <rect> element between two opposite corners.
std::string rectangle(const std::string& look, PlotPoint a, PlotPoint b);

/// Data range of a layer, its drawing, and its legend symbol around (0, 0) (empty: none).
void layer_extent(const Plot::Layer& layer, Range& x, Range& y);
std::string layer_drawing(const Plot::Layer& layer, Ink ink, const Map& map);
std::string layer_swatch(const Plot::Layer& layer, Ink ink);
/// The kind of a layer and its values as attributes (see plot_data.h), for example ` data-kind="line"
/// data-x="..."`.
std::string layer_data(const Plot::Layer& layer, const Map& map);
/// Whether a layer draws at least one value; outlines, bands and rules are not values.
bool layer_has_points(const Plot::Layer& layer);

}  // namespace faba::drawing
