#include "vision/ruler/ruler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace faba {
namespace {

constexpr int kMostMeasured = 60;  // hints that are looked into
// Writing at a fixed advance has strokes at 0.4 to 0.6 of its places, and lines of fewer letters than
// kLongRow.
constexpr double kLeastComplete = 0.7, kLeastPossible = 0.4;
constexpr int kLongRow = 30;
constexpr double kExact = 0.004;  // of the pitch; its strokes scatter by 0.008 and more
constexpr int kScaleMarks = 8;    // fewer do not make a second scale

void check(const GrayF& picture, const RulerOptions& o) {
  if (picture.width < 24 || picture.height < 12)
    throw Error(Errc::input, o.name,
                fmt::format("a picture of {} x {} px is too small to show a ruler; it takes 24 x 12 px",
                            picture.width, picture.height));
  const auto bad =
      std::find_if(picture.px.begin(), picture.px.end(), [](float v) { return !std::isfinite(v); });
  if (bad != picture.px.end()) throw Error(Errc::input, o.name, "has pixels that are not finite");
  const auto [low, high] = std::minmax_element(picture.px.begin(), picture.px.end());
  if (*low == *high) throw Error(Errc::input, o.name, "is one even grey: there is no ruler to see");
}

double direction_difference(double a, double b) { return std::fabs(std::remainder(a - b, std::numbers::pi)); }

bool same_row(const MarkRow& a, const MarkRow& b) {
  return direction_difference(a.angle, b.angle) < 0.05 && std::fabs(a.pitch_px / b.pitch_px - 1) < 0.02;
}

/// Whether the pitches are in a whole ratio, to the share `tolerance`.
bool goes_with(const MarkRow& fine, const MarkRow& coarse, double tolerance) {
  const double ratio = coarse.pitch_px / fine.pitch_px, whole = std::round(ratio);
  return whole >= 1 && std::fabs(ratio - whole) < tolerance * ratio &&
         direction_difference(fine.angle, coarse.angle) < 0.05;
}

/// Whether a row might be marks: it takes more to say so on its own account than beside a coarser row that it
/// goes with.
bool possible(const MarkRow& row, const RulerOptions& o) {
  const double share = row.used() < 8 ? 0.6 * o.max_residual_share : o.max_residual_share;
  return row.used() >= o.min_marks && row.residual_px < share * row.pitch_px && row.height_px >= 4 &&
         row.complete > kLeastPossible;
}

bool believable(const MarkRow& row, const RulerOptions& o) {
  const bool exact = row.used() >= 8 && row.complete > 0.5 && row.residual_px < kExact * row.pitch_px;
  return possible(row, o) && (row.complete > kLeastComplete || row.used() >= kLongRow || exact);
}

struct Measured {
  std::vector<MarkRow> rows;      ///< one for each direction and pitch, the best supported
  std::vector<MarkRow> possible;  ///< the same of those that are not believable alone
  int most_marks = 0;             ///< of any row, believable or not
  std::vector<PeriodHint> tried;
};

void keep(std::vector<MarkRow>& rows, const MarkRow& row) {
  const auto known =
      std::find_if(rows.begin(), rows.end(), [&](const MarkRow& r) { return same_row(r, row); });
  if (known == rows.end())
    rows.push_back(row);
  else if (row.area_px > known->area_px)
    *known = row;
}

bool alike(double angle, double pitch, const PeriodHint& hint, double by_angle) {
  return direction_difference(angle, hint.angle) < by_angle && std::fabs(pitch / hint.pitch_px - 1) < 0.04;
}

Measured measure(const GrayF& picture, const RulerOptions& o) {
  Measured out;
  std::vector<PeriodHint>& tried = out.tried;
  RowMeter meter(picture);
  for (const PeriodHint& hint : find_periods(picture)) {
    // Three strips for each direction and pitch, for one may cross a label or only the ends of marks; and of
    // what is known already one more.
    const auto like = std::count_if(tried.begin(), tried.end(), [&](const PeriodHint& h) {
      return alike(h.angle, h.pitch_px, hint, 0.02);
    });
    const bool known = std::any_of(out.rows.begin(), out.rows.end(), [&](const MarkRow& row) {
      return alike(row.angle, row.pitch_px, hint, 0.2);
    });
    if (like >= (known ? 1 : 3)) continue;
    if (int(tried.size()) >= kMostMeasured) break;
    tried.push_back(hint);
    const auto row = meter.measure(hint);
    if (!row) continue;
    out.most_marks = std::max(out.most_marks, row->used());
    if (believable(*row, o))
      keep(out.rows, *row);
    else if (possible(*row, o))
      keep(out.possible, *row);
  }
  return out;
}

/// Refuses when finer marks than those measured were seen at least as clearly, but could not be read.
void check_finest(const Measured& measured, const MarkRow& finest, const RulerOptions& o) {
  double evidence = 0;
  for (const PeriodHint& h : measured.tried)
    if (alike(finest.angle, finest.pitch_px, h, 0.1)) evidence = std::max(evidence, h.evidence);
  for (const PeriodHint& h : measured.tried) {
    const double ratio = finest.pitch_px / h.pitch_px;
    if (h.evidence > evidence && evidence > 0 && ratio > 1.5 &&
        std::fabs(ratio - std::round(ratio)) < 0.03 * ratio &&
        direction_difference(finest.angle, h.angle) < 0.1)
      throw Error(
          Errc::input, o.name,
          fmt::format("shows marks {:.1f} px apart, and between them finer ones some {:.1f} px apart that "
                      "are too faint to be measured; take a sharper picture",
                      finest.pitch_px, h.pitch_px));
  }
}

}  // namespace

Ruler find_ruler(const GrayF& picture, const RulerOptions& options) {
  check(picture, options);
  Measured measured = measure(picture, options);
  if (measured.rows.empty()) {
    const int most = measured.most_marks;
    throw Error(Errc::input, options.name,
                most >= options.min_marks ? "shows no ruler: what repeats in it is too faint or too irregular"
                : most >= 3
                    ? fmt::format("shows no ruler: at most {} marks at equal distances in a row; it takes {}",
                                  most, options.min_marks)
                    : "shows no ruler: nothing in it repeats at equal distances");
  }
  std::sort(measured.rows.begin(), measured.rows.end(),
            [](const MarkRow& a, const MarkRow& b) { return a.area_px > b.area_px; });
  const MarkRow& strongest = measured.rows.front();
  // A row at half or a third of the marks' distance finds one place in two or three taken.
  const auto finer = [&](const MarkRow& row, const MarkRow& than) {
    return row.pitch_px < 0.98 * than.pitch_px && row.complete > 1.3 * row.pitch_px / strongest.pitch_px;
  };
  const MarkRow* finest = &strongest;
  for (const MarkRow& row : measured.rows)
    if (goes_with(row, strongest, 0.02) && finer(row, *finest)) finest = &row;
  for (const MarkRow& row : measured.possible)
    if (goes_with(row, strongest, 0.005) && finer(row, *finest)) finest = &row;
  check_finest(measured, *finest, options);
  Ruler ruler;
  for (const MarkRow& row : measured.rows) {
    if (&row == finest || goes_with(*finest, row, 0.02) || goes_with(row, *finest, 0.02)) continue;
    // As much length of marks, or nearly; the lines of a grid are as far apart both ways.
    const double share = row.area_px / row.pitch_px / (finest->area_px / finest->pitch_px);
    if (share > 0.4 && row.used() >= kScaleMarks && std::fabs(row.pitch_px / finest->pitch_px - 1) > 0.02)
      throw Error(Errc::input, options.name,
                  fmt::format("shows two scales, with marks {:.2f} and {:.2f} px apart, and neither fits in "
                              "with the other; cut one out of the picture",
                              finest->pitch_px, row.pitch_px));
  }
  ruler.row = *finest;
  ruler.angle_deg = std::remainder(finest->angle, std::numbers::pi) * 180 / std::numbers::pi;
  ruler.image_width = picture.width;
  ruler.image_height = picture.height;
  return ruler;
}

}  // namespace faba
