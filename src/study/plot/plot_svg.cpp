#include "study/plot/plot_svg.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "study/plot/markup.h"
#include "study/plot/plot_layers.h"

namespace faba {
namespace {

using namespace drawing;

constexpr std::size_t kAutomaticInks = 6;
constexpr double kLegendRow = 18, kSwatch = 20;
constexpr double kDigit = 7.5;  // advance of a digit in a wide font, so that tick labels never overlap

constexpr double kMinAxisLength = 1e-200;  // above the denormal numbers

/// Range of an axis: as configured, else that of the data with a margin; its length is always positive.
Range settled(Range data, const PlotAxis& axis, double margin) {
  if (data.empty()) data = {0, 1};
  Range r{axis.lo.value_or(data.lo), axis.hi.value_or(data.hi)};
  const double pad = margin * std::max(0.0, r.length());
  if (!axis.lo) r.lo -= pad;
  if (!axis.hi) r.hi += pad;
  const double least = std::max(1e-9 * std::max(std::abs(r.lo), std::abs(r.hi)), kMinAxisLength);
  if (!(r.length() > least)) {
    const double half = std::max(0.5, 0.05 * std::abs(r.lo));
    r = axis.lo ? Range{r.lo, r.lo + 2 * half} : Range{r.lo - half, r.lo + half};
  }
  return r;
}

std::vector<Ink> inks_of(const std::vector<Plot::Layer>& layers) {
  std::vector<Ink> inks;
  std::size_t next = 0;
  for (const auto& layer : layers) {
    Ink ink = std::visit([](const auto& l) { return l.ink; }, layer);
    if (ink == Ink::automatic) ink = Ink(1 + next++ % kAutomaticInks);
    inks.push_back(ink);
  }
  return inks;
}

struct Legend {
  std::string drawing;
  double height = 0;
};

Legend legend_of(const Plot& plot, const std::vector<Ink>& inks, double left, double top) {
  Legend legend;
  double x = left, y = top + kLegendRow / 2;
  for (std::size_t i = 0; i < inks.size(); ++i) {
    const std::string& label =
        std::visit([](const auto& l) -> const std::string& { return l.label; }, plot.layers[i]);
    const std::string symbol = layer_swatch(plot.layers[i], inks[i]);
    if (label.empty() || symbol.empty()) continue;
    const double length = kSwatch + 5 + kTextWidth * character_count(label);
    if (x > left && x + length > plot.width) {
      x = left;
      y += kLegendRow;
    }
    legend.drawing +=
        fmt::format(R"svg(<g data-legend="{}"><g transform="translate({:.1f} {:.1f})">{}</g>)svg", i,
                    x + kSwatch / 2, y, symbol);
    legend.drawing += text_at({x + kSwatch + 5, y + 4}, "start", shade(Ink::text), label) + "</g>";
    legend.height = y + kLegendRow / 2 - top + 4;
    x += length + 16;
  }
  return legend;
}

/// Ticks and their labels. Large and small numbers have a common power of ten, which is part of the axis
/// label.
struct Scale {
  std::vector<double> at;
  std::vector<std::string> labels;
  std::string label;
  double width = 0;
};

Scale scale_of(Range r, int tick_count, const std::string& label, Ticks ticks = Ticks::numbers) {
  Scale scale{tick_positions(r.lo, r.hi, tick_count, ticks), {}, label};
  if (scale.at.empty()) return scale;
  const double size = std::max(std::abs(r.lo), std::abs(r.hi));
  const int exponent = size >= 1e5 || size < 1e-2 ? int(std::floor(std::log10(size))) : 0;
  const double unit = std::pow(10.0, exponent);
  const double step = scale.at.size() > 1 ? (scale.at[1] - scale.at[0]) / unit : 1;
  const int decimals = std::clamp(int(std::ceil(-std::log10(step) - 1e-6)), 0, 9);
  for (const double v : scale.at) {
    std::string text = fmt::format("{:.{}f}", std::abs(v) / unit, decimals);
    if (v < -0.5 * step * unit) text.insert(0, "\u2212");
    scale.width = std::max(scale.width, kDigit * character_count(text));
    scale.labels.push_back(std::move(text));
  }
  if (exponent != 0) scale.label += " \u00D7" + power_of_ten(exponent);
  return scale;
}

// Ticks of a logarithmic axis: decades, with 2 and 5 between them if there is space.
Scale decades_of(Range r, int tick_count, const std::string& label) {
  Scale scale{{}, {}, label};
  const int first = int(std::ceil(r.lo - 1e-9)), last = int(std::floor(r.hi + 1e-9));
  const bool between = last - first + 1 < tick_count / 2 + 1;
  const int every = std::max(1, (last - first + 1 + tick_count) / std::max(1, tick_count));
  for (int decade = first - 1; decade <= last; ++decade)
    for (const int lead : {1, 2, 5}) {
      const double at = decade + std::log10(lead);
      if (at < r.lo - 1e-9 || at > r.hi + 1e-9 || (lead > 1 && !between)) continue;
      if (lead == 1 && (decade - first) % every != 0) continue;
      const std::string plain = decade >= -2 && decade <= 3
                                    ? fmt::format("{:g}", lead * std::pow(10.0, decade))
                                : lead == 1 ? power_of_ten(decade)
                                            : fmt::format("{}\u00B7{}", lead, power_of_ten(decade));
      scale.at.push_back(at);
      scale.width = std::max(scale.width, kDigit * character_count(plain));
      scale.labels.push_back(plain);
    }
  return scale;
}

Scale scale_along(const PlotAxis& axis, Range r, int tick_count) {
  return axis.logarithmic ? decades_of(r, tick_count, axis.label)
                          : scale_of(r, tick_count, axis.label, axis.ticks);
}

double logarithm(double v) { return v > 0 ? std::log10(v) : std::numeric_limits<double>::quiet_NaN(); }

// The plot with the values of its logarithmic axes replaced by their logarithms; the axes keep their flag.
Plot with_logarithms(Plot plot) {
  const auto all = [](std::vector<double>& v) { std::transform(v.begin(), v.end(), v.begin(), logarithm); };
  const auto axis = [](PlotAxis& a) {
    if (!a.logarithmic) return;
    if (a.lo) a.lo = logarithm(*a.lo);
    if (a.hi) a.hi = logarithm(*a.hi);
  };
  axis(plot.x);
  axis(plot.y);
  for (Plot::Layer& layer : plot.layers)
    std::visit(
        [&](auto& l) {
          const bool x = plot.x.logarithmic, y = plot.y.logarithmic;
          if constexpr (requires {
                          l.of_x;
                          l.at;
                        }) {
            if (l.of_x ? x : y) l.at = logarithm(l.at);
          } else if constexpr (requires { l.of_x; }) {
            if (l.of_x ? x : y) {
              l.lo = logarithm(l.lo);
              l.hi = logarithm(l.hi);
            }
          } else if constexpr (requires { l.y.size(); }) {
            if (x) all(l.x);
            if (y) all(l.y);
          } else if constexpr (requires { l.lo.size(); }) {
            if (x) all(l.x);
            if (y) {
              all(l.lo);
              all(l.hi);
            }
          }
        },
        layer);
  return plot;
}

constexpr double kLabelLine = 14;  // distance between the two lines of a label

/// The label of a vertical axis in lines: one, or two if it is longer than the axis. It breaks at the space
/// nearest to its middle.
std::vector<std::string> label_lines(const std::string& label, double axis_length) {
  if (kTextWidth * character_count(label) <= axis_length + 20) return {label};
  std::size_t at = std::string::npos;
  const auto off_middle = [&](std::size_t i) { return std::abs(double(i) - 0.5 * double(label.size())); };
  for (std::size_t i = 0; i < label.size(); ++i)
    if (label[i] == ' ' && (at == std::string::npos || off_middle(i) < off_middle(at))) at = i;
  if (at == std::string::npos) return {label};
  return {label.substr(0, at), label.substr(at + 1)};
}

/// Width of the second line of the label of a vertical axis; 0 without one.
double second_line_width(const std::string& label, double axis_length) {
  return kLabelLine * double(label_lines(label, axis_length).size() - 1);
}

/// Label of a vertical axis, read from below; p: middle of its last line.
std::string rotated_label(PlotPoint p, const std::string& label, double axis_length, const char* axis) {
  std::string out;
  p.x -= second_line_width(label, axis_length);
  for (const std::string& line : label_lines(label, axis_length)) {
    const std::string turn =
        fmt::format(R"svg( transform="rotate(-90 {:.1f} {:.1f})" data-axis="{}")svg", p.x, p.y, axis);
    out += text_at(p, "middle", shade(Ink::text), line, turn.c_str());
    p.x += kLabelLine;
  }
  return out;
}

std::string draw_axes(const Scale& x, const Scale& y, const Scale& right, const SecondScale& second,
                      const Map& map) {
  std::string grid, text, labels;
  const double bottom = map.top + map.h, end = map.left + map.w;
  for (std::size_t i = 0; i < x.at.size(); ++i) {
    const double at = map.left + map.to_x(x.at[i]);
    grid += fmt::format("M{:.1f} {:.1f}v{:.1f}", at, map.top, map.h);
    text += text_at({at, bottom + 16}, "middle", shade(Ink::muted), x.labels[i]);
  }
  for (std::size_t i = 0; i < y.at.size(); ++i) {
    const double at = map.top + map.to_y(y.at[i]);
    grid += fmt::format("M{:.1f} {:.1f}h{:.1f}", map.left, at, map.w);
    text += text_at({map.left - 6, at + 4}, "end", shade(Ink::muted), y.labels[i]);
  }
  for (std::size_t i = 0; i < right.at.size(); ++i) {
    const double at = map.top + map.to_y((right.at[i] - second.offset) / second.per_unit);
    text += text_at({end + 6, at + 4}, "start", shade(Ink::muted), right.labels[i]);
  }
  labels +=
      text_at({map.left + map.w / 2, bottom + 34}, "middle", shade(Ink::text), x.label, R"( data-axis="x")");
  const double middle = map.top + map.h / 2;
  labels += rotated_label({map.left - y.width - 14, middle}, y.label, map.h, "y");
  if (!right.label.empty()) {
    const double at = end + right.width + 21 + second_line_width(right.label, map.h);
    labels += rotated_label({at, middle}, right.label, map.h, "right");
  }
  return fmt::format(R"(<g data-ticks=""><path {} d="{}"/>{}</g>)", stroke(kGrid), grid, text) + labels;
}

/// Gives both axes the same unit length by widening one range about its centre.
void equalise(Map& map) {
  map.h = std::clamp(map.w * map.y.length() / map.x.length(), 0.4 * map.w, 1.2 * map.w);
  const double unit = std::max(map.x.length() / map.w, map.y.length() / map.h);
  for (const auto& [range, size] : {std::pair{&map.x, map.w}, std::pair{&map.y, map.h}}) {
    const double middle = 0.5 * (range->lo + range->hi);
    *range = {middle - 0.5 * unit * size, middle + 0.5 * unit * size};
  }
}

/// Positions of all parts of the figure.
struct Layout {
  Map map;
  Scale left, right, below;
  std::vector<Ink> inks;
  Legend legend;
  SecondScale second = {};
  double height = 0;
  bool blank = false;
};

Layout layout_of(const Plot& plot) {
  Layout out;
  Range x, y;
  for (const auto& layer : plot.layers) layer_extent(layer, x, y);
  out.blank = x.empty() && y.empty();
  Map& map = out.map;
  const bool marks = std::any_of(plot.layers.begin(), plot.layers.end(),
                                 [](const auto& l) { return std::holds_alternative<Scatter>(l); });
  map = {settled(x, plot.x, marks ? 0.03 : 0), settled(y, plot.y, 0.05), plot.x.reversed, plot.y.reversed};
  map.h = plot.height - 50;
  out.left = scale_along(plot.y, map.y, std::max(2, int(map.h / 42)));
  if (plot.right) {
    const double per_unit = plot.right->per_unit, offset = plot.right->offset;
    if (std::isfinite(per_unit) && std::isfinite(offset)) out.second = *plot.right;
    const auto second = [&](double v) { return out.second.per_unit * v + out.second.offset; };
    out.right = scale_of({second(map.y.lo), second(map.y.hi)}, 5, plot.right->label);
  }
  map.left = 26 + out.left.width + second_line_width(out.left.label, map.h);
  const double right_width =
      plot.right ? out.right.width + 27 + second_line_width(out.right.label, map.h) : 14;
  map.w = std::max(60.0, plot.width - map.left - right_width);
  if (plot.equal_aspect) {
    equalise(map);
    out.left = scale_along(plot.y, map.y, std::max(2, int(map.h / 62)));
  }
  out.below = scale_along(plot.x, map.x, std::max(2, int(map.w / 62)));

  out.inks = inks_of(plot.layers);
  const double title_height = plot.title.empty() ? 0 : 24;
  out.legend = legend_of(plot, out.inks, map.left, title_height + 4);
  map.top = title_height + 8 + out.legend.height;
  out.height = map.top + map.h + 42;
  return out;
}

std::string opening(const Plot& plot, double height) {
  std::string out = "<svg class=\"faba-plot\"";
  if (!plot.inlined) out += " xmlns=\"http://www.w3.org/2000/svg\"";
  out += fmt::format(R"( viewBox="0 0 {0} {1:.0f}" width="{0}" height="{1:.0f}")", plot.width, height);
  out += fmt::format(R"( role="img" aria-label="{}")",
                     escape_markup(plot.description.empty() ? plot.title : plot.description));
  out += fmt::format(
      R"( font-family="system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif" font-size="{}")", kText);
  return out + R"( fill="none" stroke-linecap="round" stroke-linejoin="round">)";
}

/// The axes of the drawing area as attributes: values (of logarithmic axes: their decimal logarithms) at the
/// left and right, and at the bottom and top; the second scale as factor and offset.
std::string axes_data(const Plot& plot, const Map& map, const SecondScale& second) {
  const auto ends = [](Range r, bool flip) {
    return flip ? fmt::format("{} {}", r.hi, r.lo) : fmt::format("{} {}", r.lo, r.hi);
  };
  std::string out =
      fmt::format(R"( data-x="{}" data-y="{}")", ends(map.x, map.flip_x), ends(map.y, map.flip_y));
  if (plot.x.logarithmic || plot.y.logarithmic)
    out += fmt::format(R"( data-log="{}{}")", plot.x.logarithmic ? "x" : "", plot.y.logarithmic ? "y" : "");
  if (plot.right) out += fmt::format(R"( data-right="{} {}")", second.per_unit, second.offset);
  if (plot.equal_aspect) out += R"( data-equal="")";
  return out;
}

// The step of 1, 2 or 5 times a power of ten that is nearest to `raw`.
double round_step(double raw) {
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

// The smallest step of an axis of angles that is at least `raw`; below 1 degree a round number.
double degree_step(double raw) {
  if (raw < 1) return round_step(raw);
  for (const double step : {1.0, 5.0, 15.0, 45.0, 90.0, 180.0})
    if (raw <= step) return step;
  return 360;
}

}  // namespace

std::vector<double> tick_positions(double lo, double hi, int tick_count, Ticks ticks) {
  std::vector<double> at;
  if (!(lo < hi) || !std::isfinite(hi - lo)) return at;
  const double raw = (hi - lo) / std::max(1, tick_count);
  const double step = ticks == Ticks::degrees    ? degree_step(raw)
                      : ticks == Ticks::integers ? std::max(1.0, round_step(raw))
                                                 : round_step(raw);
  const double first = std::ceil(lo / step - 1e-9), last = std::floor(hi / step + 1e-9);
  for (double k = first; k <= last && at.size() < 1000; ++k) at.push_back(k * step + 0.0);
  return at;
}

bool has_values(const Plot& plot) {
  return std::any_of(plot.layers.begin(), plot.layers.end(), layer_has_points);
}

std::string svg(const Plot& given) {
  const Plot plot = given.x.logarithmic || given.y.logarithmic ? with_logarithms(given) : given;
  const Layout at = layout_of(plot);
  std::string out = opening(plot, at.height) + fmt::format("<style>{}</style>", style_sheet());
  out += rectangle(fill(kPaper), {0, 0}, {plot.width, at.height});
  if (!plot.title.empty()) {
    out += text_at({at.map.left, 18}, "start", shade(Ink::text), plot.title,
                   R"( font-weight="600" font-size="14")");
  }
  out += at.legend.drawing + draw_axes(at.below, at.left, at.right, at.second, at.map);
  // A nested <svg> clips its content without an id, which could collide with another figure on the page.
  out += fmt::format(R"(<svg x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"{}>)", at.map.left,
                     at.map.top, at.map.w, at.map.h, axes_data(plot, at.map, at.second));
  for (std::size_t i = 0; i < at.inks.size(); ++i) {
    const std::string drawing = layer_drawing(plot.layers[i], at.inks[i], at.map);
    if (drawing.empty()) continue;
    out += fmt::format(R"(<g data-layer="{}"{}>{}</g>)", i, layer_data(plot.layers[i], at.map), drawing);
  }
  if (at.blank) out += text_at({at.map.w / 2, at.map.h / 2}, "middle", shade(Ink::muted), "no data");
  return out + "</svg></svg>\n";
}

}  // namespace faba
