#include "control/plan/curve.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

namespace faba {

Curve::Curve(std::span<const Vec2> points) {
  for (const Vec2 p : points) {
    if (!points_.empty() && p == points_.back()) continue;
    at_.push_back(points_.empty() ? 0 : at_.back() + norm(p - points_.back()));
    points_.push_back(p);
  }
}

std::size_t Curve::segment(double s) const {
  const auto after = std::upper_bound(at_.begin(), at_.end(), s);
  const auto i = std::size_t(std::max<std::ptrdiff_t>(after - at_.begin(), 1) - 1);
  return std::min(i, points_.size() < 2 ? 0 : points_.size() - 2);
}

Vec2 Curve::at(double s) const {
  if (points_.size() < 2 || !(s > 0)) return points_.front();
  if (s >= length()) return points_.back();
  const std::size_t i = segment(s);
  const double f = (s - at_[i]) / (at_[i + 1] - at_[i]);
  return points_[i] + f * (points_[i + 1] - points_[i]);
}

double Curve::nearest(Vec2 p, double from, double to) const {
  from = std::clamp(from, 0.0, length());
  to = std::clamp(to, from, length());
  double best = from;
  double smallest = norm(p - at(from));
  if (points_.size() < 2) return best;
  for (std::size_t i = segment(from); i + 1 < points_.size() && at_[i] <= to; ++i) {
    const Vec2 along = points_[i + 1] - points_[i];
    const double size = at_[i + 1] - at_[i];
    const double s = std::clamp(at_[i] + dot(p - points_[i], along) / size, std::max(from, at_[i]),
                                std::min(to, at_[i + 1]));
    const double distance = norm(p - at(s));
    if (distance < smallest) {
      smallest = distance;
      best = s;
    }
  }
  return best;
}

namespace {

// Barry and Goldman's pyramid for the segment from b to c, u in [0, 1].
Vec2 catmull_rom(const std::array<Vec2, 4>& p, double u) {
  std::array<double, 4> t{};
  for (std::size_t i = 1; i < 4; ++i) t[i] = t[i - 1] + std::sqrt(std::max(norm(p[i] - p[i - 1]), 1e-300));
  const double x = t[1] + u * (t[2] - t[1]);
  const auto mix = [x](Vec2 a, Vec2 b, double ta, double tb) {
    return ((tb - x) / (tb - ta)) * a + ((x - ta) / (tb - ta)) * b;
  };
  const Vec2 a1 = mix(p[0], p[1], t[0], t[1]), a2 = mix(p[1], p[2], t[1], t[2]),
             a3 = mix(p[2], p[3], t[2], t[3]);
  return mix(mix(a1, a2, t[0], t[2]), mix(a2, a3, t[1], t[3]), t[1], t[2]);
}

int steps_of(double length, double step) { return std::max(1, int(std::ceil(length / step))); }

std::vector<Vec2> sampled(double size, double step, auto&& point) {
  const int n = std::max(64, steps_of(std::numbers::pi * size, step));
  std::vector<Vec2> out;
  for (int i = 0; i <= n; ++i) out.push_back(point(2 * std::numbers::pi * i / n));
  out.back() = out.front();
  return out;
}

}  // namespace

std::vector<Vec2> spline_through(std::span<const Vec2> points, bool closed, double step) {
  std::vector<Vec2> p;
  for (const Vec2 one : points)
    if (p.empty() || !(one == p.back())) p.push_back(one);
  if (closed && p.size() > 1 && p.front() == p.back()) p.pop_back();
  const auto n = std::ptrdiff_t(p.size());
  if (n < 2) return p;
  const auto vertex = [&](std::ptrdiff_t i) {
    if (closed) return p[std::size_t((i + n) % n)];
    // Beyond the ends the curve continues with the direction of its first or last chord.
    if (i < 0) return 2.0 * p[0] - p[1];
    if (i >= n) return 2.0 * p[std::size_t(n - 1)] - p[std::size_t(n - 2)];
    return p[std::size_t(i)];
  };
  std::vector<Vec2> out{p.front()};
  for (std::ptrdiff_t i = 0; i < (closed ? n : n - 1); ++i) {
    const std::array<Vec2, 4> around{vertex(i - 1), vertex(i), vertex(i + 1), vertex(i + 2)};
    const int count = steps_of(norm(around[2] - around[1]), step);
    for (int k = 1; k < count; ++k) out.push_back(catmull_rom(around, double(k) / count));
    out.push_back(around[2]);
  }
  return out;
}

std::vector<Vec2> figure_eight(Vec2 centre, double size, double step) {
  return sampled(1.2 * size, step, [&](double t) {
    return centre + Vec2{size / 2 * std::sin(t), -size / 4 * std::sin(2 * t)};
  });
}

std::vector<Vec2> circle(Vec2 centre, double size, double step) {
  return sampled(size, step, [&](double t) {
    return centre + Vec2{size / 2 * std::cos(t), size / 2 * std::sin(t)};
  });
}

namespace {

// One stroke for each of kOutlineCharacters on a grid of 4 x 6, y up: pairs of digits, x then y. A stroke
// goes back over itself where a letter cannot be drawn in one line.
constexpr std::array<std::string_view, kOutlineCharacters.size()> kStrokes{
    "00133313263340",
    "00063645443303334241300030",
    "1001051636453616050110304130",
    "0006264442200020",
    "000333030646060040",
    "000646060333",
    "1001051636453616050110304143234340",
    "000603434640",
    "202620",
    "01103041464130",
    "000603460340",
    "00060040",
    "0006234640",
    "0006404640",
    "10010516364541301030",
    "0006364544330333",
    "100105163645413010302240",
    "000636454433031340",
    "011030414233130405163645361605041333424130",
    "202606462620",
    "10010601103041464130",
    "2006204620",
    "10061023304630",
    "0046230640",
    "20230623462320",
    "004606460040",
    "10010516364541301001454130",
    "1030202615262030",
    "004445361605163645440040",
    "011030414233133344453616051636454433424130",
    "303602423230",
    "011030414334040646060434434130",
    "100105163616050213334241301030",
    "1046064610",
    "100102130405163645443313334241301030",
    "10304145361605041333444130",
    "",
    "1333"};
constexpr double kLetterHeight = 6, kAdvance = 6, kGap = 2;  // of that grid

}  // namespace

std::vector<Vec2> text_outline(std::string_view text, Vec2 centre, double size) {
  const double width = kAdvance * double(text.size()) - kGap, unit = size / width;
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto found = kOutlineCharacters.find(char(std::toupper(static_cast<unsigned char>(text[i]))));
    if (found == std::string_view::npos) continue;
    const std::string_view stroke = kStrokes[found];
    for (std::size_t k = 0; k + 1 < stroke.size(); k += 2) {
      const double x = kAdvance * double(i) + (stroke[k] - '0'), y = stroke[k + 1] - '0';
      out.push_back(centre + unit * Vec2{x - width / 2, kLetterHeight / 2 - y});
    }
  }
  return out;
}

}  // namespace faba
