#include "study/plot/plot_layers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "study/plot/curve_points.h"
#include "study/plot/markup.h"

namespace faba::drawing {
namespace {

// In the order of Ink, without `automatic`.
constexpr std::array<Shade, 8> kShades{{{"blue", "#0072b2", "#56b4e9"},
                                        {"vermillion", "#d55e00", "#e69f00"},
                                        {"green", "#009e73", "#009e73"},
                                        {"purple", "#cc79a7", "#cc79a7"},
                                        {"orange", "#e69f00", "#d55e00"},
                                        {"sky", "#56b4e9", "#0072b2"},
                                        {"text", "#1d2329", "#e6e9ec"},
                                        {"muted", "#5c6670", "#a4adb6"}}};

}  // namespace

const Shade& shade(Ink ink) { return kShades[ink == Ink::automatic ? 0 : std::size_t(ink) - 1]; }
// The light colour is an attribute, which all SVG renderers support; the style sheet overrides it by class.
std::string stroke(const Shade& s) { return fmt::format(R"(class="s-{}" stroke="{}")", s.name, s.light); }
std::string fill(const Shade& s) { return fmt::format(R"(class="f-{}" fill="{}")", s.name, s.light); }

std::string style_sheet() {
  std::string css = "@media screen and (prefers-color-scheme:dark){";
  const auto rule = [&](const Shade& s) {
    css += fmt::format(".faba-plot .s-{0}{{stroke:{1}}}.faba-plot .f-{0}{{fill:{1}}}", s.name, s.dark);
  };
  for (const Shade& s : kShades) rule(s);
  rule(kPaper);
  rule(kGrid);
  return css + "}";
}

double character_count(std::string_view text) {
  return double(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string text_at(PlotPoint p, const char* anchor, const Shade& s, std::string_view text,
                    const char* more) {
  return fmt::format(R"(<text {} x="{:.1f}" y="{:.1f}" text-anchor="{}"{}>{}</text>)", fill(s), p.x, p.y,
                     anchor, more, escape_markup(text));
}

std::string rectangle(const std::string& look, PlotPoint a, PlotPoint b) {
  return fmt::format(R"(<rect {} x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", look,
                     std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y));
}

namespace {

void extent(const Line& l, Range& x, Range& y) {
  for (const double v : l.x) x.take(v);
  for (const double v : l.y) y.take(v);
}
void extent(const Scatter& s, Range& x, Range& y) {
  for (const double v : s.x) x.take(v);
  for (const double v : s.y) y.take(v);
}
void extent(const Band& b, Range& x, Range& y) {
  for (const double v : {b.lo, b.hi}) (b.of_x ? x : y).take(v);
}
void extent(const Ribbon& r, Range& x, Range& y) {
  for (const double v : r.x) x.take(v);
  for (const auto* side : {&r.lo, &r.hi})
    for (const double v : *side) y.take(v);
}
void extent(const ErrorBars& e, Range& x, Range& y) {
  for (const double v : e.x) x.take(v);
  for (const auto* end : {&e.lo, &e.hi})
    for (const double v : *end) y.take(v);
}
void extent(const Rule& r, Range& x, Range& y) { (r.of_x ? x : y).take(r.at); }
void extent(const Ellipse& e, Range& x, Range& y) {
  for (const double side : {-1.0, 1.0}) {
    x.take(e.x + side * e.radius_x);
    y.take(e.y + side * e.radius_y);
  }
}
void extent(const Box& b, Range& x, Range& y) {
  for (const double v : {b.x0, b.x1}) x.take(v);
  for (const double v : {b.y0, b.y1}) y.take(v);
}

void append_section(std::string& path, const std::vector<PlotPoint>& section, bool stairs) {
  const auto out = std::back_inserter(path);
  fmt::format_to(out, "M{:.1f} {:.1f}", section[0].x, section[0].y);
  if (section.size() == 1) path += "h0";  // with round caps, a dot
  for (std::size_t i = 1; i < section.size(); ++i) {
    if (stairs)
      fmt::format_to(out, "H{:.1f}V{:.1f}", section[i].x, section[i].y);
    else
      fmt::format_to(out, "L{:.1f} {:.1f}", section[i].x, section[i].y);
  }
}

std::string dashes(bool dashed) { return dashed ? R"( stroke-dasharray="6 5")" : ""; }

std::string draw(const Line& line, Ink ink, const Map& map) {
  std::string path;
  for (const auto& section : curve_sections(line, map)) append_section(path, section, line.stairs);
  if (path.empty()) return {};
  return fmt::format(R"(<path {} stroke-width="{}"{} d="{}"/>)", stroke(shade(ink)), line.width,
                     dashes(line.dashed), path);
}

/// Path data of one mark; dots are zero-length strokes with round caps.
std::string mark_at(const Scatter& s, PlotPoint p) {
  const double r = s.size / 2;
  switch (s.mark) {
    case Scatter::Mark::ring:
      return fmt::format("M{:.1f} {:.1f}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0", p.x - r, p.y, 2 * r, -2 * r,
                         fmt::arg("r", r));
    case Scatter::Mark::cross:
      return fmt::format("M{:.1f} {:.1f}h{}m{} {}v{}", p.x - r, p.y, 2 * r, -r, -r, 2 * r);
    case Scatter::Mark::dot:
      break;
  }
  return fmt::format("M{:.1f} {:.1f}h0", p.x, p.y);
}

double mark_stroke(const Scatter& s) { return s.mark == Scatter::Mark::dot ? s.size : 2; }

std::string draw(const Scatter& s, Ink ink, const Map& map) {
  std::vector<std::pair<std::int64_t, std::int64_t>> half_units;  // duplicates at this resolution are dropped
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
    half_units.emplace_back(std::llround(2 * map.to_x(s.x[i])), std::llround(2 * map.to_y(s.y[i])));
  }
  std::sort(half_units.begin(), half_units.end());
  half_units.erase(std::unique(half_units.begin(), half_units.end()), half_units.end());
  if (half_units.empty()) return {};
  std::string path;
  for (const auto& [x, y] : half_units) path += mark_at(s, {0.5 * double(x), 0.5 * double(y)});
  return fmt::format(R"(<path {} stroke-width="{}" d="{}"/>)", stroke(shade(ink)), mark_stroke(s), path);
}

std::string draw(const Band& b, Ink ink, const Map& map) {
  if (!std::isfinite(b.lo) || !std::isfinite(b.hi)) return {};
  const std::string look = fill(shade(ink)) + R"( fill-opacity="0.18")";
  if (b.of_x) return rectangle(look, {map.to_x(b.lo), 0}, {map.to_x(b.hi), map.h});
  return rectangle(look, {0, map.to_y(b.lo)}, {map.w, map.to_y(b.hi)});
}

std::string draw(const Ribbon& r, Ink ink, const Map& map) {
  std::string out, upper, lower;
  const auto close = [&] {
    if (!upper.empty())
      out +=
          fmt::format(R"(<polygon {} fill-opacity="0.25" points="{}{}"/>)", fill(shade(ink)), upper, lower);
    upper.clear();
    lower.clear();
  };
  for (std::size_t i = 0; i < std::min({r.x.size(), r.lo.size(), r.hi.size()}); ++i) {
    if (!std::isfinite(r.x[i] + r.lo[i] + r.hi[i])) {
      close();  // a gap, as in a line
      continue;
    }
    upper += fmt::format("{:.1f},{:.1f} ", map.to_x(r.x[i]), map.to_y(r.hi[i]));
    lower.insert(0, fmt::format("{:.1f},{:.1f} ", map.to_x(r.x[i]), map.to_y(r.lo[i])));
  }
  close();
  return out;
}

constexpr double kCap = 3;  // half the width of the cap of an error bar

std::string draw(const ErrorBars& e, Ink ink, const Map& map) {
  std::string path;
  for (std::size_t i = 0; i < std::min({e.x.size(), e.lo.size(), e.hi.size()}); ++i) {
    if (!std::isfinite(e.x[i] + e.lo[i] + e.hi[i])) continue;
    const double x = map.to_x(e.x[i]), lo = map.to_y(e.lo[i]), hi = map.to_y(e.hi[i]);
    path += fmt::format("M{0:.1f} {1:.1f}H{2:.1f}M{3:.1f} {1:.1f}V{4:.1f}M{0:.1f} {4:.1f}H{2:.1f}", x - kCap,
                        lo, x + kCap, x, hi);
  }
  if (path.empty()) return {};
  return fmt::format(R"(<path {} stroke-width="1.2" d="{}"/>)", stroke(shade(ink)), path);
}

std::string draw(const Rule& r, Ink ink, const Map& map) {
  if (!std::isfinite(r.at)) return {};
  const double at = r.of_x ? map.to_x(r.at) : map.to_y(r.at);
  std::string out = fmt::format(
      R"(<path {} stroke-width="1.2" stroke-dasharray="3 3" d="M{:.1f} {:.1f}{}{:.1f}"/>)",
      stroke(shade(ink)), r.of_x ? at : 0, r.of_x ? 0 : at, r.of_x ? 'V' : 'H', r.of_x ? map.h : map.w);
  if (r.label.empty()) return out;
  const bool label_left = r.of_x && at + 6 + kTextWidth * character_count(r.label) > map.w;
  const PlotPoint spot =
      r.of_x ? PlotPoint{label_left ? at - 5 : at + 5, 14} : PlotPoint{map.w - 4, at < 20 ? at + 14 : at - 5};
  const char* anchor = label_left || !r.of_x ? "end" : "start";
  out += fmt::format(R"(<g class="s-paper" stroke="{}" stroke-width="4" paint-order="stroke">{}</g>)",
                     kPaper.light, text_at(spot, anchor, shade(ink), r.label));
  return out;
}

std::string draw(const Ellipse& e, Ink ink, const Map& map) {
  if (!std::isfinite(e.x + e.y + e.radius_x + e.radius_y)) return {};
  const PlotPoint c{map.to_x(e.x), map.to_y(e.y)};
  const double rx = std::abs(e.radius_x) * map.w / map.x.length(),
               ry = std::abs(e.radius_y) * map.h / map.y.length();
  return fmt::format(R"(<ellipse {} stroke-width="1.5"{} cx="{:.1f}" cy="{:.1f}" rx="{:.1f}" ry="{:.1f}"/>)",
                     stroke(shade(ink)), dashes(e.dashed), c.x, c.y, std::min(rx, kMaxCoordinate),
                     std::min(ry, kMaxCoordinate));
}

std::string draw(const Box& b, Ink ink, const Map& map) {
  if (!std::isfinite(b.x0 + b.y0 + b.x1 + b.y1)) return {};
  return rectangle(stroke(shade(ink)) + R"( stroke-width="1.5")" + dashes(b.dashed),
                   {map.to_x(b.x0), map.to_y(b.y0)}, {map.to_x(b.x1), map.to_y(b.y1)});
}

bool has_finite(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) return true;
  return false;
}

// Legend symbols of the layers, around (0, 0).
std::string swatch(const Line& l, Ink ink) {
  return fmt::format(R"(<path {} stroke-width="{}"{} d="M-9 0h18"/>)", stroke(shade(ink)),
                     std::max(2.0, l.width), dashes(l.dashed));
}
std::string swatch(const Scatter& s, Ink ink) {
  return fmt::format(R"(<path {} stroke-width="{}" d="{}"/>)", stroke(shade(ink)), mark_stroke(s),
                     mark_at(s, {0, 0}));
}
std::string swatch(const Ribbon&, Ink ink) {
  return rectangle(fill(shade(ink)) + R"( fill-opacity="0.3")", {-9, -5}, {9, 5});
}
std::string swatch(const Band&, Ink ink) {
  return rectangle(fill(shade(ink)) + R"( fill-opacity="0.3")", {-9, -5}, {9, 5});
}
std::string swatch(const ErrorBars&, Ink ink) {
  return fmt::format(R"(<path {} stroke-width="1.2" d="M0 -6v12M-3 -6h6M-3 6h6"/>)", stroke(shade(ink)));
}
std::string swatch(const Rule&, Ink) { return {}; }  // has its label in the plot
template <class Outline>
std::string swatch(const Outline& o, Ink ink) {
  return fmt::format(R"(<path {} stroke-width="1.5"{} d="M-9 0h18"/>)", stroke(shade(ink)), dashes(o.dashed));
}

bool has_points(const Line& l) { return has_finite(l.x, l.y); }
bool has_points(const Scatter& s) { return has_finite(s.x, s.y); }
bool has_points(const Ribbon& r) { return has_finite(r.lo, r.hi); }
bool has_points(const ErrorBars& e) { return has_finite(e.lo, e.hi); }
template <class Outline>
bool has_points(const Outline&) {
  return false;
}

}  // namespace

bool layer_has_points(const Plot::Layer& layer) {
  return std::visit([](const auto& l) { return has_points(l); }, layer);
}
void layer_extent(const Plot::Layer& layer, Range& x, Range& y) {
  std::visit([&](const auto& l) { extent(l, x, y); }, layer);
}
std::string layer_drawing(const Plot::Layer& layer, Ink ink, const Map& map) {
  return std::visit([&](const auto& l) { return draw(l, ink, map); }, layer);
}
std::string layer_swatch(const Plot::Layer& layer, Ink ink) {
  return std::visit([&](const auto& l) { return swatch(l, ink); }, layer);
}

}  // namespace faba::drawing
