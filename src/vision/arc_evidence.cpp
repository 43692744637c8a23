#include "vision/arc_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace faba {
namespace {

constexpr double kStep = 0.5;      // radial sampling, px
constexpr double kExpected = 0.9;  // share of agreeing pieces on a true edge, for choosing the run
constexpr double kTolerances[] = {0.5, 1, 2, 3.5, 6};  // px; the best is chosen and paid for in the test
constexpr double kClear = -3;  // log10 of false alarms below which a tolerance may be chosen

/// One piece of arc: its mean direction and the grey across it.
struct Piece {
  double angle = 0, width = 0;  // rad
  std::vector<double> grey;
  std::size_t stretch = 0;  // number of the unbroken part of the circle in the picture that it belongs to
  double shift = 0;         // where the others' profile fits best, px
};

struct Strip {
  std::vector<Piece> pieces;
  bool closed = false;  // the last piece touches the first
  int half = 0;         // profiles have 2 half + 1 samples, 1 px apart
  double piece_px = 0;
};

/// Bilinear sample; positions outside take the nearest border pixel.
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

/// The angles under which the picture can be seen from the centre.
AngleRange angles_of_view(const GrayF& im, Vec2 centre) {
  const double w = im.width - 1, h = im.height - 1;
  if (centre.x >= 0 && centre.x <= w && centre.y >= 0 && centre.y <= h)
    return {-std::numbers::pi, std::numbers::pi};
  const double middle = std::atan2(h / 2 - centre.y, w / 2 - centre.x);
  double low = 0, high = 0;
  for (const Vec2 corner : {Vec2{0, 0}, Vec2{w, 0}, Vec2{0, h}, Vec2{w, h}}) {
    const double d =
        std::remainder(std::atan2(corner.y - centre.y, corner.x - centre.x) - middle, 2 * std::numbers::pi);
    low = std::min(low, d), high = std::max(high, d);
  }
  return {middle + low, middle + high};
}

/// Mean of the middle half: cells and dust crossing a piece do not count. Reorders v.
double middle_mean(std::vector<float>& v) {
  const std::size_t n = v.size(), cut = n / 4;
  if (n > 40) {
    const auto at = [&](std::size_t i) { return v.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(0), at(cut), at(n));
    std::nth_element(at(cut), at(n - cut), at(n));
  } else {
    for (std::size_t i = 1; i < n; ++i) {  // insertion: the fastest sort of a dozen numbers
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

Piece read_piece(const GrayF& im, const Circle& c, std::span<const double> angles, int half,
                 std::size_t stretch) {
  return {0.5 * (angles.front() + angles.back()), angles.back() - angles.front(),
          mean_profile(im, c, angles, half), stretch, 0};
}

void cut_into_pieces(Strip& strip, const GrayF& im, const Circle& c,
                     const std::vector<std::vector<double>>& stretches, const ArcEvidenceOptions& o) {
  std::size_t total = 0;
  for (const auto& stretch : stretches) total += stretch.size();
  strip.piece_px = std::max(o.piece_px, double(total) / o.max_pieces);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const std::size_t size = stretches[s].size(), pieces = std::size_t(double(size) / strip.piece_px);
    for (std::size_t k = 0; k < pieces; ++k) {
      const std::span<const double> all(stretches[s]);
      const std::size_t first = k * size / pieces, last = (k + 1) * size / pieces;
      strip.pieces.push_back(read_piece(im, c, all.subspan(first, last - first), strip.half, s));
    }
  }
}

Strip read_strip(const GrayF& im, const Circle& c, const ArcEvidenceOptions& o) {
  Strip strip;
  strip.half = int(o.half_width);
  const AngleRange range = angles_of_view(im, c.centre);
  const double core = o.margin, turn = range.last - range.first;
  const double far_x = std::max(c.centre.x, im.width - 1 - c.centre.x);
  const double far_y = std::max(c.centre.y, im.height - 1 - c.centre.y);
  if (!(c.radius > 0 && c.radius < norm({far_x, far_y}))) return strip;  // passes outside the picture
  const std::size_t n = std::max<std::size_t>(8, std::size_t(std::ceil(turn * c.radius)));
  auto seen = [&](double angle, double r) {
    const double x = c.centre.x + r * std::cos(angle), y = c.centre.y + r * std::sin(angle);
    return x >= 0 && y >= 0 && x <= im.width - 1 && y <= im.height - 1;
  };
  std::vector<double> angles(n);
  for (std::size_t i = 0; i < n; ++i) angles[i] = range.first + turn * (double(i) + 0.5) / double(n);
  std::vector<bool> visible(n);
  for (std::size_t i = 0; i < n; ++i)
    visible[i] = seen(angles[i], c.radius - core) && seen(angles[i], c.radius + core);
  // A full turn starts where the circle is out of view, so that no stretch is cut in two by the seam.
  const bool full_turn = turn > 6.28;
  const std::size_t hidden = std::size_t(std::find(visible.begin(), visible.end(), false) - visible.begin());
  strip.closed = full_turn && hidden == n;
  const std::size_t start = full_turn && !strip.closed ? hidden : 0;
  std::vector<std::vector<double>> stretches(1);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (start + i) % n;
    if (visible[k])
      stretches.back().push_back(angles[k] + (start + i >= n ? turn : 0));
    else if (!stretches.back().empty())
      stretches.emplace_back();
  }
  cut_into_pieces(strip, im, c, stretches, o);
  return strip;
}

/// Takes mean and slope out of v (of odd length), so that its product with any straight line is zero.
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

/// Sum of squares about its mean of every window of `length` samples of the piece.
std::vector<double> window_energy(const std::vector<double>& grey, std::size_t length) {
  std::vector<double> energy;
  double sum = 0, squares = 0;
  const double n = double(length), base = grey.front();
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double in = grey[i] - base;
    sum += in, squares += in * in;
    if (i + 1 < length) continue;
    energy.push_back(std::max(squares - sum * sum / n, 0.0));
    const double out = grey[i + 1 - length] - base;
    sum -= out, squares -= out * out;
  }
  return energy;
}

/// Where along the piece the template has the largest product with it, for its length and for the unrest of
/// the grey there: a bright cell has a large product with anything. `usual` is the energy of a window without
/// such things.
double best_shift(const std::vector<double>& grey, const std::vector<double>& shape, int half, int quarter,
                  double usual) {
  const std::vector<double> energy = window_energy(grey, shape.size());
  std::vector<double> product;
  for (int s = -quarter; s <= quarter; ++s) {
    double sum = 0;
    const double* g = &grey[std::size_t(half + s - quarter)];
    for (std::size_t i = 0; i < shape.size(); ++i) sum += shape[i] * g[i];
    product.push_back(sum / std::sqrt(energy[std::size_t(half + s - quarter)] + usual));
  }
  const std::size_t top = std::size_t(std::max_element(product.begin(), product.end()) - product.begin());
  double fine = 0;
  if (top > 0 && top + 1 < product.size()) {
    const double a = product[top - 1], b = product[top], c = product[top + 1], bend = a - 2 * b + c;
    if (bend < 0) fine = 0.5 * (a - c) / bend;
  }
  return double(top) - quarter + fine;
}

void find_shifts(Strip& strip) {
  const int quarter = strip.half / 2;
  const std::size_t length = std::size_t(2 * quarter + 1), first = std::size_t(strip.half - quarter);
  std::vector<double> sum(length, 0.0), others(length), energies;
  for (const Piece& p : strip.pieces) {
    for (std::size_t i = 0; i < length; ++i) sum[i] += p.grey[first + i];
    energies.push_back(window_energy(p.grey, length)[first]);
  }
  const auto middle = energies.begin() + std::ptrdiff_t(energies.size() / 2);
  std::nth_element(energies.begin(), middle, energies.end());
  const double usual = std::max(*middle, 1e-12);
  for (Piece& p : strip.pieces) {
    for (std::size_t i = 0; i < length; ++i) others[i] = sum[i] - p.grey[first + i];
    remove_line(others);
    p.shift = best_shift(p.grey, others, strip.half, quarter, usual);
  }
}

/// log10 of P(at least k successes in n trials of probability p).
double log10_tail(std::size_t n, std::size_t k, double p) {
  double sum = 0, largest = 0;
  std::vector<double> terms;
  for (std::size_t i = k; i <= n; ++i) {
    const double ni = double(n), ii = double(i);
    terms.push_back(std::lgamma(ni + 1) - std::lgamma(ii + 1) - std::lgamma(ni - ii + 1) + ii * std::log(p) +
                    (ni - ii) * std::log1p(-p));
  }
  largest = *std::max_element(terms.begin(), terms.end());
  for (double t : terms) sum += std::exp(t - largest);
  return (largest + std::log(sum)) / std::numbers::ln10;
}

/// A run of pieces [first, first + length), wrapping round a closed strip.
struct Run {
  std::size_t first = 0, length = 0, hits = 0;
};

/// The run with the best likelihood of "edge" against "chance".
Run best_run(const std::vector<bool>& hit, bool closed, double p) {
  const double gain = std::log(kExpected / p), loss = std::log((1 - kExpected) / (1 - p));
  Run best;
  double best_score = 0, score = 0;
  Run now;
  const std::size_t n = hit.size(), reach = closed ? 2 * n : n;
  for (std::size_t i = 0; i < reach; ++i) {
    if (score <= 0) now = {i, 0, 0}, score = 0;
    if (now.length == n) break;
    score += hit[i % n] ? gain : loss;
    now.length += 1;
    now.hits += hit[i % n];
    if (score > best_score) best_score = score, best = now;
  }
  return best;
}

/// Root mean square of the profile's middle half without its line.
double relief(const std::vector<double>& profile, int half) {
  std::vector<double> middle(profile.begin() + half - half / 2, profile.begin() + half + half / 2 + 1);
  remove_line(middle);
  const double sum = std::inner_product(middle.begin(), middle.end(), middle.begin(), 0.0);
  return std::sqrt(sum / double(middle.size()));
}

/// The test at one tolerance.
struct Verdict {
  double tolerance = 0, log10_alarms = 1e9;
  Run run;
};

/// Probability that a piece agrees within a tolerance by chance.
double chance(const Strip& strip, double tolerance) { return 2 * tolerance / (2 * (strip.half / 2) + 1); }

std::vector<Verdict> judge(const Strip& strip, double log10_circles) {
  std::vector<Verdict> verdicts;
  const double n = double(strip.pieces.size());
  // What was chosen among is paid for: circles told apart by a pixel, runs of pieces, tolerances.
  const double tests = log10_circles + std::log10(n * n * double(std::size(kTolerances)));
  for (double tolerance : kTolerances) {
    std::vector<bool> hit;
    for (const Piece& p : strip.pieces) hit.push_back(std::fabs(p.shift) <= tolerance);
    const double p = chance(strip, tolerance);
    Verdict v{tolerance, 1e9, best_run(hit, strip.closed, p)};
    if (v.run.hits >= 4) v.log10_alarms = log10_tail(v.run.length, v.run.hits, p) + tests;
    verdicts.push_back(v);
  }
  return verdicts;
}

/// The tightest tolerance that loses next to nothing of the arc the widest one shows, for the profile and the
/// support: an edge that is not quite a circle must not be taken for a better circle along a part of it.
struct Choice {
  Verdict tight, wide;
};

Choice choose(const std::vector<Verdict>& verdicts) {
  Choice c;
  c.tight = c.wide = *std::min_element(verdicts.begin(), verdicts.end(), [](const auto& a, const auto& b) {
    return a.log10_alarms < b.log10_alarms;
  });
  for (const Verdict& v : verdicts)
    if (v.log10_alarms < kClear && v.run.hits > c.wide.run.hits) c.wide = v;
  for (const Verdict& v : verdicts)
    if (v.log10_alarms < kClear && double(v.run.hits) >= 0.9 * double(c.wide.run.hits)) {
      c.tight = v;
      break;
    }
  return c;
}

/// The stretches in which a run agrees more than once in a hundred by chance. A corner of the picture that
/// the circle happens to cross must not be fitted along with a true arc elsewhere.
std::vector<bool> solid_stretches(const Strip& strip, const Verdict& v) {
  const std::size_t count = strip.pieces.back().stretch + 1;
  std::vector<std::size_t> pieces(count), hits(count);
  for (std::size_t i = 0; i < v.run.length; ++i) {
    const Piece& p = strip.pieces[(v.run.first + i) % strip.pieces.size()];
    pieces[p.stretch] += 1;
    hits[p.stretch] += std::fabs(p.shift) <= v.tolerance;
  }
  std::vector<bool> solid(count);
  for (std::size_t s = 0; s < count; ++s)
    solid[s] = hits[s] > 0 && log10_tail(pieces[s], hits[s], chance(strip, v.tolerance)) < -2;
  return solid;
}

/// Which pieces of a run see the same edge as their neighbours: within 3 robust sd of the median of five. Not
/// being on the circle is no reason to be left out.
std::vector<std::size_t> steady_pieces(const Strip& strip, const Run& run) {
  const std::size_t n = strip.pieces.size(), length = run.length;
  auto shift = [&](std::size_t i) { return strip.pieces[(run.first + i) % n].shift; };
  std::vector<double> off(length), sizes;
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t from = std::min(i > 2 ? i - 2 : 0, length > 5 ? length - 5 : 0);
    std::vector<double> five;
    for (std::size_t k = from; k < std::min(from + 5, length); ++k) five.push_back(shift(k));
    std::nth_element(five.begin(), five.begin() + std::ptrdiff_t(five.size() / 2), five.end());
    off[i] = std::fabs(shift(i) - five[five.size() / 2]);
    if (off[i] > 0) sizes.push_back(off[i]);
  }
  std::vector<std::size_t> steady;
  if (sizes.empty()) sizes.push_back(0);
  std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
  const double limit = std::max(3 * 1.4826 * sizes[sizes.size() / 2], 0.25);
  for (std::size_t i = 0; i < length; ++i)
    if (off[i] <= limit && std::fabs(shift(i)) < strip.half / 2) steady.push_back((run.first + i) % n);
  return steady;
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

ArcEvidence weigh_arc(const GrayF& picture, const Circle& circle, const ArcEvidenceOptions& options) {
  ArcEvidence e;
  Strip strip = read_strip(picture, circle, options);
  e.visible = strip.pieces.size();
  if (e.visible < 4) return e;
  find_shifts(strip);
  const double w = picture.width, h = picture.height;
  const std::vector<Verdict> verdicts = judge(strip, std::log10(w * h * (w + h)));
  const auto [tight, wide] = choose(verdicts);
  for (const Verdict& v : verdicts) e.log10_false_alarms = std::min(e.log10_false_alarms, v.log10_alarms);
  e.tolerance_px = tight.tolerance;
  std::vector<double> mean(std::size_t(2 * strip.half + 1), 0.0);
  for (std::size_t i = 0; i < tight.run.length; ++i) {
    const Piece& p = strip.pieces[(tight.run.first + i) % e.visible];
    if (std::fabs(p.shift) > tight.tolerance) continue;
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += p.grey[k] / double(tight.run.hits);
    for (double part : {-0.375, -0.125, 0.125, 0.375}) e.angles.push_back(p.angle + part * p.width);
  }
  const std::vector<bool> solid = solid_stretches(strip, wide);
  for (std::size_t k : steady_pieces(strip, wide.run)) {
    const Piece& p = strip.pieces[k];
    if (!solid[p.stretch]) continue;
    const double r = circle.radius + p.shift;
    e.points.push_back({circle.centre.x + r * std::cos(p.angle), circle.centre.y + r * std::sin(p.angle)});
  }
  e.relief = relief(mean, strip.half);
  e.support = double(wide.run.hits) / double(e.visible);
  e.piece_px = strip.piece_px;
  e.length_px = double(wide.run.hits) * strip.piece_px;
  return e;
}

}  // namespace faba
