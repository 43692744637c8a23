#include "vision/drop/arc_strip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/statistics.h"

namespace faba {
namespace {

/// Bilinear sample; positions outside are clamped to the border.
float bilinear(const GrayF& im, double x, double y) {
  const float fx = std::clamp(float(x), 0.0f, float(im.width - 1) - 1e-3f);
  const float fy = std::clamp(float(y), 0.0f, float(im.height - 1) - 1e-3f);
  const int c = int(fx), r = int(fy);
  const float* p = &im.px[std::size_t(r) * std::size_t(im.width) + std::size_t(c)];
  const float top = p[0] + (fx - float(c)) * (p[1] - p[0]);
  const float low = p[im.width] + (fx - float(c)) * (p[im.width + 1] - p[im.width]);
  return top + (fy - float(r)) * (low - top);
}

struct AngleRange {
  double first, last;
};

/// Range of directions from the centre to the picture.
AngleRange angles_of_view(const GrayF& im, Vec2 centre) {
  const double w = im.width - 1, h = im.height - 1;
  if (centre.x >= 0 && centre.x <= w && centre.y >= 0 && centre.y <= h)
    return {-std::numbers::pi, std::numbers::pi};
  const double middle = std::atan2(h / 2 - centre.y, w / 2 - centre.x);
  double low = 0, high = 0;
  for (const Vec2 corner : {Vec2{0, 0}, Vec2{w, 0}, Vec2{0, h}, Vec2{w, h}}) {
    const double d =
        std::remainder(std::atan2(corner.y - centre.y, corner.x - centre.x) - middle, 2 * std::numbers::pi);
    low = std::min(low, d);
    high = std::max(high, d);
  }
  return {middle + low, middle + high};
}

/// Interquartile mean, robust against cells and dust. Reorders v.
double middle_mean(std::vector<float>& v) {
  const std::size_t n = v.size(), cut = n / 4;
  if (n > 40) {
    const auto at = [&](std::size_t i) { return v.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(0), at(cut), at(n));
    std::nth_element(at(cut), at(n - cut), at(n));
  } else {
    for (std::size_t i = 1; i < n; ++i) {  // insertion sort: fastest for about a dozen values
      const float x = v[i];
      std::size_t k = i;
      for (; k > 0 && v[k - 1] > x; --k) v[k] = v[k - 1];
      v[k] = x;
    }
  }
  double sum = 0;
  for (std::size_t i = cut; i < n - cut; ++i) sum += double(v[i]);
  return sum / double(n - 2 * cut);
}

ArcPiece read_piece(const GrayF& im, const Circle& c, std::span<const double> angles, int half,
                    std::size_t segment) {
  return {0.5 * (angles.front() + angles.back()), angles.back() - angles.front(),
          mean_profile(im, c, angles, half), segment, 0};
}

void cut_into_pieces(ArcStrip& strip, const GrayF& im, const Circle& c,
                     const std::vector<std::vector<double>>& segments, const ArcStripOptions& o) {
  std::size_t total = 0;
  for (const auto& segment : segments) total += segment.size();
  strip.piece_px = std::max(o.piece_px, double(total) / o.max_pieces);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::size_t size = segments[s].size(), pieces = std::size_t(double(size) / strip.piece_px);
    for (std::size_t k = 0; k < pieces; ++k) {
      const std::span<const double> all(segments[s]);
      const std::size_t first = k * size / pieces, last = (k + 1) * size / pieces;
      strip.pieces.push_back(read_piece(im, c, all.subspan(first, last - first), strip.half, s));
    }
  }
}

/// Sum of squared deviations from the mean, for every window of `length` samples.
std::vector<double> window_energy(const std::vector<double>& grey, std::size_t length) {
  std::vector<double> energy;
  double sum = 0, squares = 0;
  const double n = double(length), base = grey.front();
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double in = grey[i] - base;
    sum += in;
    squares += in * in;
    if (i + 1 < length) continue;
    energy.push_back(std::max(squares - sum * sum / n, 0.0));
    const double out = grey[i + 1 - length] - base;
    sum -= out;
    squares -= out * out;
  }
  return energy;
}

/// Template matching: shift with the largest product of template and piece, normalised by the local energy of
/// the piece, because a bright cell has a large product with any template. `typical_energy` is the energy of
/// a window without such objects.
double best_shift(const std::vector<double>& grey, const std::vector<double>& shape, int half, int reach,
                  double typical_energy) {
  const std::vector<double> energy = window_energy(grey, shape.size());
  std::vector<double> product;
  for (int s = -reach; s <= reach; ++s) {
    double sum = 0;
    const double* g = &grey[std::size_t(half + s - reach)];
    for (std::size_t i = 0; i < shape.size(); ++i) sum += shape[i] * g[i];
    product.push_back(sum / std::sqrt(energy[std::size_t(half + s - reach)] + typical_energy));
  }
  const std::size_t top = std::size_t(std::max_element(product.begin(), product.end()) - product.begin());
  double fine = 0;
  if (top > 0 && top + 1 < product.size()) {
    const double a = product[top - 1], b = product[top], c = product[top + 1], bend = a - 2 * b + c;
    if (bend < 0) fine = 0.5 * (a - c) / bend;
  }
  return double(top) - reach + fine;
}

}  // namespace

std::vector<double> mean_profile(const GrayF& picture, const Circle& c, std::span<const double> angles,
                                 int half) {
  std::vector<double> profile;
  std::vector<Vec2> direction;
  for (double a : angles) direction.push_back({std::cos(a), std::sin(a)});
  std::vector<float> values(angles.size());
  for (int i = -half; i <= half; ++i) {
    const double r = c.radius + i;
    for (std::size_t k = 0; k < direction.size(); ++k)
      values[k] = bilinear(picture, c.centre.x + r * direction[k].x, c.centre.y + r * direction[k].y);
    profile.push_back(middle_mean(values));
  }
  return profile;
}

ArcStrip read_arc_strip(const GrayF& im, const Circle& c, const ArcStripOptions& o) {
  ArcStrip strip;
  strip.half = o.half_width;
  const AngleRange range = angles_of_view(im, c.centre);
  const double turn = range.last - range.first;
  const double far_x = std::max(c.centre.x, im.width - 1 - c.centre.x);
  const double far_y = std::max(c.centre.y, im.height - 1 - c.centre.y);
  if (!(c.radius > 0 && c.radius < norm(Vec2{far_x, far_y}))) return strip;  // passes outside the picture
  const std::size_t n = std::max<std::size_t>(8, std::size_t(std::ceil(turn * c.radius)));
  std::vector<double> angles(n);
  for (std::size_t i = 0; i < n; ++i) angles[i] = range.first + turn * (double(i) + 0.5) / double(n);
  std::vector<bool> visible(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = c.centre.x + c.radius * std::cos(angles[i]),
                 y = c.centre.y + c.radius * std::sin(angles[i]);
    visible[i] = x >= o.border_px && y >= o.border_px && x <= im.width - 1 - o.border_px &&
                 y <= im.height - 1 - o.border_px;
  }
  // A full turn starts outside the view, so that no segment is split at the start angle.
  const bool full_turn = turn > 6.28;
  const std::size_t hidden = std::size_t(std::find(visible.begin(), visible.end(), false) - visible.begin());
  strip.closed = full_turn && hidden == n;
  const std::size_t start = full_turn && !strip.closed ? hidden : 0;
  std::vector<std::vector<double>> segments(1);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (start + i) % n;
    if (visible[k])
      segments.back().push_back(angles[k] + (start + i >= n ? turn : 0));
    else if (!segments.back().empty())
      segments.emplace_back();
  }
  cut_into_pieces(strip, im, c, segments, o);
  return strip;
}

void remove_line(std::vector<double>& v) {
  const double n = double(v.size()), middle = (n - 1) / 2;
  double mean = 0, slope = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    mean += v[i] / n;
    slope += v[i] * (double(i) - middle);
  }
  slope /= n * (n * n - 1) / 12;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] -= mean + slope * (double(i) - middle);
}

void align_by_profile(ArcStrip& strip) {
  const int reach = strip.reach();
  const auto length = 2 * std::size_t(reach) + 1, first = std::size_t(strip.half) - std::size_t(reach);
  std::vector<double> sum(length, 0.0), others(length), energies;
  for (const ArcPiece& p : strip.pieces) {
    for (std::size_t i = 0; i < length; ++i) sum[i] += p.grey[first + i];
    energies.push_back(window_energy(p.grey, length)[first]);
  }
  const double typical_energy = std::max(median_high(energies), 1e-12);
  for (ArcPiece& p : strip.pieces) {
    for (std::size_t i = 0; i < length; ++i) others[i] = sum[i] - p.grey[first + i];
    remove_line(others);
    p.shift = best_shift(p.grey, others, strip.half, reach, typical_energy);
  }
}

void align_by_change(ArcStrip& strip) {
  const int n = 2 * strip.half + 1;
  // Lower limit of the variance, a quarter of the median: the logarithm of a smaller one would dominate the
  // cost.
  std::vector<double> noise;
  for (const ArcPiece& p : strip.pieces) {
    double sum = 0;
    for (std::size_t i = 1; i < p.grey.size(); ++i)
      sum += (p.grey[i] - p.grey[i - 1]) * (p.grey[i] - p.grey[i - 1]);
    noise.push_back(sum / 2 / (n - 1));
  }
  const double floor = std::max(0.25 * median_high(noise), 1e-9);
  for (ArcPiece& p : strip.pieces) {
    std::vector<double> sum{0}, squares{0};
    for (double g : p.grey) {
      const double x = g - p.grey[0];
      sum.push_back(sum.back() + x);
      squares.push_back(squares.back() + x * x);
    }
    auto spread_cost = [&](std::size_t from, std::size_t to) {
      const double count = double(to - from), s = sum[to] - sum[from];
      return count * std::log((squares[to] - squares[from] - s * s / count) / count + floor);
    };
    double best = 1e300;
    for (int s = -strip.reach(); s <= strip.reach(); ++s) {
      const auto split = static_cast<std::size_t>(std::ptrdiff_t{strip.half} + s);
      const double cost = spread_cost(0, split) + spread_cost(split, std::size_t(n));
      if (cost < best) {
        best = cost;
        p.shift = s - 0.5;
      }
    }
  }
}

}  // namespace faba
