#include "vision/ruler/mark_row.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/statistics.h"
#include "vision/ruler/mark_chain.h"
#include "vision/ruler/mark_shape.h"
#include "vision/ruler/rotated_picture.h"

namespace faba {
namespace {

constexpr int kFitPasses = 3;
constexpr double kDistortion = 0.02;  // px, distortion from end to end by shading (assumed)
constexpr double kMaxBend = 3e-4;     // rad: for a smaller inclination the picture is not rotated again

/// Linear model position = offset + pitch * index + lean * t.
struct Plane {
  double offset = 0, pitch = 0, lean = 0, sd = 0;
  double off(const StripReading& r) const { return r.s - offset - pitch * r.index - lean * r.t; }
};

std::optional<Plane> fit_plane(std::vector<StripReading>& readings) {
  Plane plane;
  for (int round = 0; round < 6; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double t0 = 0, count = 0;
    for (const StripReading& r : readings) {
      t0 += r.used ? r.t : 0;
      count += r.used ? 1 : 0;
    }
    if (count < 6) return std::nullopt;
    t0 /= count;
    for (const StripReading& r : readings) {
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
    sizes.reserve(readings.size());
    for (const StripReading& r : readings) sizes.push_back(std::fabs(plane.off(r)));
    plane.sd = kMadToSd * median_high(sizes);
    bool same = true;
    for (StripReading& r : readings) {
      const bool use = std::fabs(plane.off(r)) <= 4 * plane.sd + 1e-6;
      same = same && use == r.used;
      r.used = use;
    }
    if (same) break;
  }
  return plane;
}

/// State of the measurement of one row: position, and the last readings.
struct RowState {
  double angle, pitch, t;
  int height;
  StripReadings readings;
  Plane plane;
};

bool read_row(const RotatedPicture& rotated, RowState& at, int strip_height, MarkShape& shape) {
  const double top = rotated.last_t() - (at.height - 1) / 2.0;
  at.t = std::clamp(at.t, std::min(-top, top), std::max(-top, top));
  const std::vector<double> raw = rotated.profile(at.t, at.height);
  if (raw.empty()) return false;
  const MarkProfile y(rotated.first_s(), raw, at.pitch);
  const MarkChain chain = trace_marks(y, at.pitch);
  if (int(chain.size()) < kMinMarks) return false;
  at.pitch = mean_gap(chain);
  std::vector<double> positions;
  for (const auto& [index, position] : chain) positions.push_back(position);
  shape = MarkShape({&y, 1}, {&positions, 1}, at.pitch);
  at.readings = {};
  follow_marks(rotated, chain, at.pitch, shape, at.t, 1, strip_height, at.readings);
  follow_marks(rotated, chain, at.pitch, shape, at.t - strip_height, -1, strip_height, at.readings);
  const auto plane = fit_plane(at.readings.list);
  if (!plane || !(plane->pitch > 0.8 * at.pitch && plane->pitch < 1.25 * at.pitch)) return false;
  at.plane = *plane;
  return true;
}

/// Rotates by the inclination of the marks and moves to the centre of the readings.
void realign(const RotatedPicture& rotated, const GrayF& picture, RowState& at) {
  double s = 0, t = 0, count = 0, low = 1e300, high = -1e300;
  for (const StripReading& r : at.readings.list) {
    if (!r.used) continue;
    s += r.s;
    t += r.t;
    ++count;
    low = std::min(low, r.t);
    high = std::max(high, r.t);
  }
  const Vec2 middle = rotated.image(s / count, t / count);
  if (std::fabs(at.plane.lean) > kMaxBend) at.angle -= std::atan(at.plane.lean);
  at.pitch = at.plane.pitch / std::hypot(1, at.plane.lean);
  const Vec2 centre{(picture.width - 1) / 2.0, (picture.height - 1) / 2.0};
  const Vec2 d = middle - centre;
  at.t = d.y * std::cos(at.angle) - d.x * std::sin(at.angle);
  at.height = std::max(1, int(0.5 * (high - low)));
}

/// One position per mark, the mean over its strips; marks with few readings are excluded.
std::vector<RowMark> marks_of(const RowState& at, const RotatedPicture& rotated) {
  std::map<int, std::vector<const StripReading*>> by_index;
  std::size_t most = 0;
  for (const StripReading& r : at.readings.list)
    if (r.used) by_index[r.index].push_back(&r);
  for (const auto& [index, list] : by_index) most = std::max(most, list.size());
  std::vector<RowMark> marks;
  for (const auto& [index, list] : by_index) {
    if (4 * list.size() < most) continue;
    RowMark m;
    m.index = index;
    double low = list.front()->t, high = low;
    for (const StripReading* r : list) {
      m.s += (r->s - at.plane.lean * r->t) / double(list.size());
      low = std::min(low, r->t);
      high = std::max(high, r->t);
    }
    m.from_image = rotated.image(m.s, low);
    m.to_image = rotated.image(m.s, high);
    marks.push_back(m);
  }
  return marks;
}

/// When only every second or third index has a mark, the pitch is two or three times the assumed one: returns
/// this factor.
int index_step(const std::vector<RowMark>& marks) {
  for (const int step : {2, 3})
    for (int rest = 0; rest < step; ++rest) {
      const auto off = std::count_if(marks.begin(), marks.end(), [&](const RowMark& m) {
        return (m.index % step + step) % step != rest;
      });
      if (double(off) <= 0.15 * double(marks.size())) return step;
    }
  return 1;
}

/// Least-squares line through the mark positions, with exclusion of outliers.
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
    // Correlated residuals contain less information than independent ones (lag-1 autocorrelation).
    const double rho = squares > 0 ? std::clamp(neighbours / squares, 0.0, 0.9) : 0;
    row.se_pitch_px = row.residual_px / std::sqrt(kk) * std::sqrt((1 + rho) / (1 - rho));
    const double ends = row.marks.back().index - row.marks.front().index;
    row.se_pitch_px = std::hypot(row.se_pitch_px, kDistortion / ends);
    bool same = true;
    std::vector<double> sizes;
    for (const RowMark& m : row.marks) sizes.push_back(std::fabs(m.residual_px));
    const double most = std::max(4 * kMadToSd * median_high(sizes), 0.02);
    for (RowMark& m : row.marks) {
      const bool use = std::fabs(m.residual_px) <= most;
      same = same && use == m.used;
      m.used = use;
    }
    if (same) return;
  }
}

std::optional<MarkRow> row_of(const RowState& at, const RotatedPicture& rotated, int strip,
                              const MarkShape& shape) {
  MarkRow row;
  row.marks = marks_of(at, rotated);
  if (int(row.marks.size()) < kMinMarks) return std::nullopt;
  fit_line(row);
  row.angle = at.angle - std::atan(at.plane.lean);
  const double shrink = 1 / std::hypot(1, at.plane.lean);
  row.pitch_px *= shrink;
  row.se_pitch_px *= shrink;
  row.width_px = shape.width_px();
  row.dark = shape.dark();
  double low = 1e300, high = -1e300, count = 0;
  for (const StripReading& r : at.readings.list) {
    if (!r.used) continue;
    low = std::min(low, r.t);
    high = std::max(high, r.t);
    ++count;
  }
  row.height_px = high - low + strip;
  row.area_px = count * strip * row.pitch_px;
  const int span = row.marks.back().index - row.marks.front().index + 1;
  row.complete = std::min(1.0, count / at.readings.expected * double(row.marks.size()) / span);
  const Vec2 centre{shape.centre_px() * std::cos(row.angle), shape.centre_px() * std::sin(row.angle)};
  for (RowMark& m : row.marks) {
    m.from_image = m.from_image + centre;
    m.to_image = m.to_image + centre;
  }
  return row;
}

}  // namespace

int MarkRow::used() const {
  return int(std::count_if(marks.begin(), marks.end(), [](const RowMark& m) { return m.used; }));
}

const RotatedPicture& RowMeter::rotated(double angle) {
  const auto existing = rotated_.find(angle);
  return existing != rotated_.end() ? existing->second
                                    : rotated_.try_emplace(angle, picture_, angle).first->second;
}

std::optional<MarkRow> RowMeter::measure(const PeriodHint& hint) {
  // Thin strips tolerate an angle error, tall strips tolerate noise.
  auto thin =
      measure_marks(hint, std::clamp(int(hint.pitch_px / 3), 3, std::max(3, std::min(8, hint.height_px))));
  if ((thin && thin->complete > 0.8) || hint.height_px < 12) return thin;
  const auto tall = measure_marks(hint, std::min(hint.height_px, 18));
  return !thin || (tall && tall->complete * tall->area_px > thin->complete * thin->area_px) ? tall : thin;
}

std::optional<MarkRow> RowMeter::measure_marks(const PeriodHint& hint, int strip) {
  auto row = measure_positions(hint, strip);
  const int factor = row ? index_step(row->marks) : 1;
  if (factor == 1) return row;
  PeriodHint wider = hint;
  wider.pitch_px *= factor;
  const auto again = measure_positions(wider, strip);
  return again && index_step(again->marks) == 1 ? again : std::nullopt;
}

std::optional<MarkRow> RowMeter::measure_positions(const PeriodHint& hint, int strip) {
  RowState at{hint.angle, hint.pitch_px, hint.across_px, hint.height_px, {}, {}};
  std::optional<RotatedPicture> straight;
  MarkShape shape({}, {}, at.pitch);
  for (int pass = 0; pass < kFitPasses; ++pass) {
    if (pass > 0) {
      const RotatedPicture& before = straight ? *straight : rotated(hint.angle);
      const double lean = at.plane.lean;
      realign(before, picture_, at);
      if (std::fabs(lean) > kMaxBend) straight.emplace(picture_, at.angle);
      strip = std::max(std::clamp(at.height / 5, 3, 16), std::min(strip, at.height));
    }
    if (!read_row(straight ? *straight : rotated(hint.angle), at, strip, shape)) return std::nullopt;
    if (at.plane.sd > 0.25 * at.pitch || double(at.readings.list.size()) < 0.4 * at.readings.expected)
      return std::nullopt;
  }
  return row_of(at, straight ? *straight : rotated(hint.angle), strip, shape);
}

}  // namespace faba
