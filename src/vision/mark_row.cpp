#include "vision/mark_row.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "vision/mark_shape.h"
#include "vision/turned_picture.h"

namespace faba {
namespace {

constexpr int kLeastMarks = 4, kPasses = 3;
constexpr double kFloor = 0.02;      // px from end to end that shading may bring in (assumed)
constexpr double kStraight = 3e-4;  // rad: marks leaning less need no other turned picture

/// One mark in one strip.
struct Reading {
  int index;
  double s, t;
  bool used = true;
};

/// What was read, and how much there was to read.
struct Readings {
  std::vector<Reading> list;
  int possible = 0;
};

/// Where the marks of the strip in the middle are, by index.
using Chain = std::map<int, double>;

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  const auto middle = v.begin() + std::ptrdiff_t(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// The place where the profile swings most strongly and purely at the pitch: the middle of a mark.
double best_place(const MarkProfile& y, double pitch) {
  const double reach = 2.5 * pitch, wave = 2 * std::numbers::pi / pitch;
  const int n = int(y.flat.size());
  double best = -1, place = 0;
  for (double middle = reach; middle < n - reach; middle += pitch / 2) {
    std::complex<double> sum = 0;
    double power = 0;
    bool whole = true;
    for (int i = std::max(0, int(middle - reach)); i < std::min(n, int(middle + reach) + 1); ++i) {
      const double v = y.flat[std::size_t(i)], u = (i - middle) / reach;
      if (!std::isfinite(v)) whole = false;
      const double weight = std::max(0.0, 1 - u * u);
      sum += weight * v * std::polar(1.0, -wave * (i - middle));
      power += weight * v * v;
    }
    const double worth = whole && power > 0 ? std::norm(sum) / std::sqrt(power) : -1;
    if (worth <= best) continue;
    best = worth;
    place = middle - std::arg(-sum) / wave;
  }
  return y.first_s + place;
}

/// Walks from `start` to one side (`step` is +1 or -1), adding to the chain.
void walk(const MarkProfile& y, double start, double pitch, const MarkShape& shape, int step, Chain& chain) {
  double at = start, gap = pitch;
  int missing = 0;
  for (int index = step; missing <= 3; index += step) {
    at += step * gap;
    const MarkReading r = read_mark(y, at, pitch, shape);
    missing = r.there ? 0 : missing + 1;
    if (!r.there) continue;
    chain[index] = at + r.shift_px;
    at += 0.5 * r.shift_px;
    gap = std::clamp(gap + 0.1 * step * r.shift_px, 0.9 * pitch, 1.1 * pitch);
  }
}

double mean_gap(const Chain& chain) {
  double k = 0, s = 0, kk = 0, ks = 0;
  const double n = double(chain.size());
  for (const auto& [index, place] : chain) {
    k += index / n;
    s += place / n;
  }
  for (const auto& [index, place] : chain) {
    kk += (index - k) * (index - k);
    ks += (index - k) * (place - s);
  }
  return ks / kk;
}

Chain walk_both(const MarkProfile& y, double pitch) {
  double start = best_place(y, pitch);
  std::vector<double> near;
  for (int k = -2; k <= 2; ++k) near.push_back(start + k * pitch);
  Chain chain;
  // First with the look of the five marks about the best place, then with that of all that were found, from
  // the middle of a mark: a bright one is half a pitch off at first.
  for (int round = 0; round < 3; ++round) {
    MarkShape shape({&y, 1}, {&near, 1}, pitch);
    if (round == 1) {
      start += shape.centre_px();
      for (double& place : near) place += shape.centre_px();
      shape = MarkShape({&y, 1}, {&near, 1}, pitch);
    }
    chain.clear();
    walk(y, start, pitch, shape, 1, chain);
    walk(y, start, pitch, shape, -1, chain);
    const MarkReading first = read_mark(y, start, pitch, shape);
    if (first.there) chain[0] = start + first.shift_px;
    if (int(chain.size()) < kLeastMarks) return {};
    const double gap = mean_gap(chain);
    if (!(gap > 0.85 * pitch && gap < 1.15 * pitch)) return {};
    pitch = gap;
    near.clear();
    for (const auto& [index, place] : chain) near.push_back(place);
  }
  return chain;
}

/// Follows the chain's marks along their length, on the strips above or below (`step` -1 or +1).
class Follower {
 public:
  Follower(const TurnedPicture& turned, const Chain& chain, double pitch, const MarkShape& shape, int height)
      : turned_(turned), chain_(chain), pitch_(pitch), shape_(shape), height_(height) {}

  void go(double t, int step, Readings& out) const {
    double offset = 0;
    const int patience = std::max(2, int(0.4 * pitch_ / height_));
    for (int missed = 0; missed <= patience; t += step * height_) {
      const std::vector<double> raw = turned_.profile(t, height_);
      if (raw.empty()) return;
      const MarkProfile y(turned_.first_s(), raw, pitch_);
      std::vector<Reading> seen;
      std::vector<double> shifts;
      int possible = 0;
      for (const auto& [index, place] : chain_) {
        const double at = place + offset;
        if (!inside(y, at)) continue;
        ++possible;
        const MarkReading r = read_mark(y, at, pitch_, shape_);
        if (!r.there) continue;
        seen.push_back({index, at + r.shift_px, t});
        shifts.push_back(r.shift_px);
      }
      const bool good = possible >= kLeastMarks && 2 * int(seen.size()) > possible;
      missed = good ? 0 : missed + 1;
      if (!good) continue;
      offset += median(shifts);
      out.list.insert(out.list.end(), seen.begin(), seen.end());
      // Marks that the row itself went across count as missing.
      out.possible += possible;
    }
  }

 private:
  bool inside(const MarkProfile& y, double at) const {
    const double reach = std::max(pitch_ / 2, 2.5) + 1;
    const int from = int(at - reach - y.first_s), to = int(at + reach - y.first_s) + 1;
    return from >= 0 && to < int(y.raw.size()) && std::isfinite(y.raw[std::size_t(from)]) &&
           std::isfinite(y.raw[std::size_t(to)]);
  }
  const TurnedPicture& turned_;
  const Chain& chain_;
  double pitch_;
  const MarkShape& shape_;
  int height_;
};

/// place = offset + pitch * index + lean * t.
struct Plane {
  double offset = 0, pitch = 0, lean = 0, sd = 0;
  double off(const Reading& r) const { return r.s - offset - pitch * r.index - lean * r.t; }
};

std::optional<Plane> fit_plane(std::vector<Reading>& readings) {
  Plane plane;
  for (int round = 0; round < 6; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double t0 = 0, count = 0;
    for (const Reading& r : readings) {
      t0 += r.used ? r.t : 0;
      count += r.used ? 1 : 0;
    }
    if (count < 6) return std::nullopt;
    t0 /= count;
    for (const Reading& r : readings) {
      if (!r.used) continue;
      const Eigen::Vector3d x(1, r.index, r.t - t0);
      normal += x * x.transpose();
      right += r.s * x;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    const Eigen::Vector3d k = solver.solve(right);
    if (!k.allFinite() || solver.vectorD().minCoeff() <= 1e-9 * solver.vectorD().maxCoeff())
      return std::nullopt;
    plane = {k[0] - k[2] * t0, k[1], k[2], 0};
    std::vector<double> sizes;
    for (const Reading& r : readings) sizes.push_back(std::fabs(plane.off(r)));
    plane.sd = 1.4826 * median(sizes);
    bool same = true;
    for (Reading& r : readings) {
      const bool use = std::fabs(plane.off(r)) <= 4 * plane.sd + 1e-6;
      same = same && use == r.used;
      r.used = use;
    }
    if (same) break;
  }
  return plane;
}

/// State of the search for one row: where to look, and what was read there last.
struct Look {
  double angle, pitch, t;
  int height;
  Readings readings;
  Plane plane;
};

bool look(const TurnedPicture& turned, Look& at, int strip_height, MarkShape* seen) {
  const double top = turned.last_t() - (at.height - 1) / 2.0;
  at.t = std::clamp(at.t, std::min(-top, top), std::max(-top, top));
  const std::vector<double> raw = turned.profile(at.t, at.height);
  if (raw.empty()) return false;
  const MarkProfile y(turned.first_s(), raw, at.pitch);
  const Chain chain = walk_both(y, at.pitch);
  if (int(chain.size()) < kLeastMarks) return false;
  at.pitch = mean_gap(chain);
  std::vector<double> places;
  for (const auto& [index, place] : chain) places.push_back(place);
  const MarkShape shape({&y, 1}, {&places, 1}, at.pitch);
  if (seen) *seen = shape;
  at.readings = {};
  const Follower follower(turned, chain, at.pitch, shape, strip_height);
  follower.go(at.t, 1, at.readings);
  follower.go(at.t - strip_height, -1, at.readings);
  const auto plane = fit_plane(at.readings.list);
  if (!plane || !(plane->pitch > 0.8 * at.pitch && plane->pitch < 1.25 * at.pitch)) return false;
  at.plane = *plane;
  return true;
}

/// Turns by the lean of the marks and moves to the middle of what was read.
void turn(const TurnedPicture& turned, const GrayF& picture, Look& at) {
  double s = 0, t = 0, count = 0, low = 1e300, high = -1e300;
  for (const Reading& r : at.readings.list) {
    if (!r.used) continue;
    s += r.s;
    t += r.t;
    ++count;
    low = std::min(low, r.t);
    high = std::max(high, r.t);
  }
  const Vec2 middle = turned.image(s / count, t / count);
  if (std::fabs(at.plane.lean) > kStraight) at.angle -= std::atan(at.plane.lean);
  at.pitch = at.plane.pitch / std::hypot(1, at.plane.lean);
  const Vec2 centre{(picture.width - 1) / 2.0, (picture.height - 1) / 2.0};
  const Vec2 d = middle - centre;
  at.t = d.y * std::cos(at.angle) - d.x * std::sin(at.angle);
  at.height = std::max(1, int(0.5 * (high - low)));
}

/// One place for each mark, the mean over its strips; few readings of a mark are not worth a place.
std::vector<RowMark> marks_of(const Look& at, const TurnedPicture& turned) {
  std::map<int, std::vector<const Reading*>> by_index;
  std::size_t most = 0;
  for (const Reading& r : at.readings.list)
    if (r.used) by_index[r.index].push_back(&r);
  for (const auto& [index, list] : by_index) most = std::max(most, list.size());
  std::vector<RowMark> marks;
  for (const auto& [index, list] : by_index) {
    if (4 * list.size() < most) continue;
    RowMark m;
    m.index = index;
    double low = list.front()->t, high = low;
    for (const Reading* r : list) {
      m.s += (r->s - at.plane.lean * r->t) / double(list.size());
      low = std::min(low, r->t);
      high = std::max(high, r->t);
    }
    m.from_image = turned.image(m.s, low);
    m.to_image = turned.image(m.s, high);
    marks.push_back(m);
  }
  return marks;
}

/// The line through the marks' places, by least squares; again without marks that stand far off.
void fit_line(MarkRow& row) {
  for (int round = 0; round < 4; ++round) {
    double n = 0, k = 0, s = 0, kk = 0, ks = 0;
    for (const RowMark& m : row.marks) {
      if (!m.used) continue;
      ++n;
      k += m.index;
      s += m.s;
    }
    if (n < 3) return;
    k /= n;
    s /= n;
    for (const RowMark& m : row.marks) {
      if (!m.used) continue;
      kk += (m.index - k) * (m.index - k);
      ks += (m.index - k) * (m.s - s);
    }
    row.pitch_px = ks / kk;
    double squares = 0, neighbours = 0, before = 0;
    for (RowMark& m : row.marks) {
      m.residual_px = m.s - s - row.pitch_px * (m.index - k);
      if (!m.used) continue;
      squares += m.residual_px * m.residual_px;
      neighbours += m.residual_px * before;
      before = m.residual_px;
    }
    row.residual_px = std::sqrt(squares / (n - 2));
    // Residuals that go along with their neighbours tell less than as many independent ones.
    const double rho = squares > 0 ? std::clamp(neighbours / squares, 0.0, 0.9) : 0;
    row.se_pitch_px = row.residual_px / std::sqrt(kk) * std::sqrt((1 + rho) / (1 - rho));
    const double ends = row.marks.back().index - row.marks.front().index;
    row.se_pitch_px = std::hypot(row.se_pitch_px, kFloor / ends);
    bool same = true;
    std::vector<double> sizes;
    for (const RowMark& m : row.marks) sizes.push_back(std::fabs(m.residual_px));
    const double most = std::max(4 * 1.4826 * median(sizes), 0.02);
    for (RowMark& m : row.marks) {
      const bool use = std::fabs(m.residual_px) <= most;
      same = same && use == m.used;
      m.used = use;
    }
    if (same) return;
  }
}

}  // namespace

int MarkRow::used() const {
  return int(std::count_if(marks.begin(), marks.end(), [](const RowMark& m) { return m.used; }));
}

const TurnedPicture& RowMeter::turned(double angle) {
  const auto known = turned_.find(angle);
  return known != turned_.end() ? known->second : turned_.try_emplace(angle, picture_, angle).first->second;
}

std::optional<MarkRow> RowMeter::measure(const PeriodHint& hint) {
  Look at{hint.angle, hint.pitch_px, hint.across_px, hint.height_px, {}, {}};
  std::optional<TurnedPicture> straight;
  for (int pass = 0;; ++pass) {
    if (pass > 0 && std::fabs(at.plane.lean) > kStraight) straight.emplace(picture_, at.angle);
    const TurnedPicture& turned = straight ? *straight : this->turned(at.angle);
    const int strip = pass == 0 ? std::clamp(int(at.pitch / 3), 3, std::max(3, std::min(8, at.height)))
                                : std::clamp(at.height / 5, 3, 16);
    std::vector<MarkProfile> none;
    MarkShape shape(none, {}, at.pitch);
    if (!look(turned, at, strip, &shape)) return std::nullopt;
    if (pass + 1 < kPasses) {
      if (at.plane.sd > 0.25 * at.pitch || double(at.readings.list.size()) < 0.4 * at.readings.possible)
        return std::nullopt;
      turn(turned, picture_, at);
      continue;
    }
    MarkRow row;
    row.marks = marks_of(at, turned);
    if (int(row.marks.size()) < kLeastMarks) return std::nullopt;
    fit_line(row);
    row.angle = at.angle - std::atan(at.plane.lean);
    const double shrink = 1 / std::hypot(1, at.plane.lean);
    row.pitch_px *= shrink;
    row.se_pitch_px *= shrink;
    row.width_px = shape.width_px();
    row.dark = shape.dark();
    double low = 1e300, high = -1e300, count = 0;
    for (const Reading& r : at.readings.list) {
      if (!r.used) continue;
      low = std::min(low, r.t);
      high = std::max(high, r.t);
      ++count;
    }
    row.height_px = high - low + strip;
    row.area_px = count * strip * row.pitch_px;
    const int span = row.marks.back().index - row.marks.front().index + 1;
    row.complete = count / at.readings.possible * double(row.marks.size()) / span;
    const Vec2 centre{shape.centre_px() * std::cos(row.angle), shape.centre_px() * std::sin(row.angle)};
    for (RowMark& m : row.marks) {
      m.from_image = m.from_image + centre;
      m.to_image = m.to_image + centre;
    }
    return row;
  }
}

}  // namespace faba
