#include "study/pages/tracks/track_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "study/plot/markup.h"

namespace faba {
namespace {

struct Unit {
  double length = 1;  // per px
  std::string name = "px";
};

Figure speed_figure(const TrackSummary& s, const Unit& unit,
                    const std::vector<SpeedPopulation>& populations) {
  Figure f{"Speeds",
           fmt::format(
               "Displacements over {} s divided by this interval, corrected for the localisation error; {} "
               "displacements.",
               three_digits(s.interval_s), s.speed_count),
           {}};
  f.plot.description = "Distribution of speeds";
  f.plot.inlined = true;
  f.plot.x.label = fmt::format("speed ({}/s)", unit.name);
  f.plot.y.label = "fraction of displacements (%)";
  f.plot.y.lo = 0;
  f.plot.x.lo = 0;
  Ribbon bars{{}, {}, {}, {}, Ink::blue};
  Line outline{{}, {}, {}, Ink::blue};
  outline.width = 1.2;
  for (std::size_t i = 0; i < s.speeds_px_s.counts.size(); ++i)
    for (const std::size_t edge : {i, i + 1}) {
      bars.x.push_back(unit.length * s.speeds_px_s.edges[edge]);
      bars.lo.push_back(0);
      bars.hi.push_back(100 * s.speeds_px_s.counts[i] / double(s.speed_count));
    }
  outline.x = bars.x;
  outline.y = bars.hi;
  f.plot.add(bars).add(outline);
  if (populations.size() < 2) {
    const double mean = unit.length * s.mean_speed_px_s.value;
    f.plot.add(Rule{mean, "mean " + three_digits(mean), true, Ink::text});
  } else {
    f.caption += " Lines: medians of the populations.";
    for (const SpeedPopulation& p : populations) {
      const double speed = unit.length * p.speed_px_s;
      f.plot.add(Rule{speed, std::string(word_of(p.motion)) + " " + three_digits(speed), true, Ink::text});
    }
  }
  return f;
}

Figure msd_figure(const TrackSummary& s, const Unit& unit) {
  const double area = unit.length * unit.length;
  Figure f{"Mean-square displacement",
           "Relative to the common drift, against lag. Shaded: ± two standard errors (jackknife over groups "
           "of tracks).",
           {}};
  f.plot.description = "Mean-square displacement against lag";
  f.plot.inlined = true;
  f.plot.x.logarithmic = f.plot.y.logarithmic = true;
  f.plot.x.label = "lag (s)";
  f.plot.y.label = fmt::format("MSD ({}²)", unit.name);
  Ribbon band{{}, {}, {}, {}, Ink::blue};
  Scatter points{{}, {}, "measured", Ink::blue};
  for (std::size_t k = 0; k < s.msd.size(); ++k) {
    const double m = s.msd.msd_px2[k], two = 2 * s.msd.se_px2[k];
    points.x.push_back(s.msd.lag_s[k]);
    points.y.push_back(area * m);
    band.x.push_back(s.msd.lag_s[k]);
    band.lo.push_back(area * std::max(m - two, 0.02 * m));
    band.hi.push_back(area * (m + two));
  }
  f.plot.add(band);
  const auto curve = [&](const char* label, Ink ink, bool dashed, double first, const auto& msd) {
    Line line{{}, {}, label, ink, dashed};
    const double last = s.msd.lag_s.back();
    for (int i = 0; i <= 60; ++i) {
      line.x.push_back(first * std::pow(last / first, i / 60.0));
      line.y.push_back(area * msd(line.x.back()));
    }
    f.plot.add(line);
  };
  if (s.diffusion.good)
    curve("4 D t + 4 s²", Ink::vermillion, s.persists, s.msd.lag_s[s.diffusion.first],
          [&](double t) { return diffusion_msd(s.diffusion, t); });
  if (s.persistent.good && s.persists)
    curve("persistent walk", Ink::green, false, s.msd.lag_s.front(),
          [&](double t) { return persistent_msd(s.persistent, t); });
  f.plot.add(points);
  if (s.diffusion.good)
    f.caption += fmt::format(" The diffusion law is fitted to {} lags from {} s.", s.diffusion.lags,
                             three_digits(s.msd.lag_s[s.diffusion.first]));
  return f;
}

Figure heading_figure(const TrackSummary& s) {
  Figure f{
      "Direction over time",
      "Dots: direction of the mean velocity in the picture (counter-clockwise: 0 right, 90 degrees up), at "
      "times with "
      "significant common motion (left axis). Line: order parameter, the length of the mean displacement "
      "over the mean length of the displacements (right axis): 0 for random directions, 1 for one direction.",
      {}};
  f.plot.description = "Mean heading over time";
  f.plot.inlined = true;
  f.plot.x.label = "time (s)";
  f.plot.y.label = "heading (degrees, counter-clockwise)";
  f.plot.y.ticks = Ticks::degrees;
  f.plot.y.lo = -180;
  f.plot.y.hi = 180;
  // The curve is drawn in units of the right axis, from 0 to 1.
  f.plot.right = SecondScale{1.0 / 360, "order parameter", 0.5};
  Scatter heading{{}, {}, "heading", Ink::blue};
  heading.size = 4;
  Line order{{}, {}, "order parameter (right axis)", Ink::orange};
  order.width = 1.2;
  for (std::size_t i = 0; i < s.time_s.size(); ++i) {
    order.x.push_back(s.time_s[i]);
    order.y.push_back(360 * s.order_in_time[i] - 180);
    // n random directions have an order parameter of about 1 / sqrt(n).
    if (!(s.order_in_time[i] > std::max(0.2, 2.5 / std::sqrt(s.count_in_time[i])))) continue;
    heading.x.push_back(s.time_s[i]);
    heading.y.push_back(std::atan2(-s.velocity_y_px_s[i], s.velocity_x_px_s[i]) * 180 / std::numbers::pi);
  }
  f.plot.add(order).add(heading);
  return f;
}

}  // namespace

std::vector<Figure> track_figures(const TrackSummary& s, double um_per_px,
                                  const std::vector<SpeedPopulation>& populations) {
  const Unit unit = um_per_px > 0 ? Unit{um_per_px, "µm"} : Unit{};
  std::vector<Figure> figures;
  if (!s.speeds_px_s.counts.empty()) figures.push_back(speed_figure(s, unit, populations));
  if (s.msd.size() > 1) figures.push_back(msd_figure(s, unit));
  if (s.time_s.size() > 2) figures.push_back(heading_figure(s));
  return figures;
}

Plot path_plot(const std::vector<TrackLine>& tracks, int width, int height) {
  Plot p;
  p.description = "Paths of the tracks";
  p.x.label = "x (px)";
  p.y.label = "y (px)";
  p.x.lo = 0;
  p.x.hi = width;
  p.y.lo = 0;
  p.y.hi = height;
  p.y.reversed = true;
  p.equal_aspect = true;
  p.width = 620;
  constexpr Ink kInks[] = {Ink::blue, Ink::vermillion, Ink::green, Ink::purple, Ink::orange, Ink::sky};
  for (const TrackLine& track : tracks) {
    Line line;
    line.ink = kInks[track.number % std::size(kInks)];
    line.width = 1;
    for (const Vec2 at : track.path) {
      line.x.push_back(at.x);
      line.y.push_back(at.y);
    }
    p.add(std::move(line));
  }
  return p;
}

}  // namespace faba
