#include "vision/ruler/ruler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace faba {
namespace {

constexpr int kMostMeasured = 60;  // maximum number of hints measured
// Monospaced text has strokes at a fraction of 0.4 to 0.6 of its positions, and lines of fewer characters
// than kLongRow.
constexpr double kMinComplete = 0.7, kMinPossible = 0.4;
constexpr int kLongRow = 30;
constexpr double kExact = 0.004;  // fraction of the pitch; the strokes of text scatter by 0.008 and more
constexpr int kScaleMarks = 8;    // minimum number of marks of a second scale

void check(const GrayF& picture, const RulerOptions& o) {
  if (picture.width < 24 || picture.height < 12)
    throw Error(
        Errc::input, o.name,
        fmt::format("a picture of {} x {} px is too small for a ruler; it must be at least 24 x 12 px",
                    picture.width, picture.height));
  const auto bad =
      std::find_if(picture.px.begin(), picture.px.end(), [](float v) { return !std::isfinite(v); });
  if (bad != picture.px.end())
    throw Error(Errc::input, o.name, "has pixels that are not finite; export it from the camera again");
  const auto [low, high] = std::minmax_element(picture.px.begin(), picture.px.end());
  if (*low == *high)
    throw Error(Errc::input, o.name, "the picture is uniform, no ruler detected; check light and exposure");
}

double direction_difference(double a, double b) { return std::fabs(std::remainder(a - b, std::numbers::pi)); }

bool same_row(const MarkRow& a, const MarkRow& b) {
  return direction_difference(a.angle, b.angle) < 0.05 && std::fabs(a.pitch_px / b.pitch_px - 1) < 0.02;
}

/// Whether the pitches have an integer ratio, within the fraction `tolerance`.
bool has_integer_ratio(const MarkRow& fine, const MarkRow& coarse, double tolerance) {
  const double ratio = coarse.pitch_px / fine.pitch_px, nearest = std::round(ratio);
  return nearest >= 1 && std::fabs(ratio - nearest) < tolerance * ratio &&
         direction_difference(fine.angle, coarse.angle) < 0.05;
}

/// Whether a row can be marks. Sufficient only beside a coarser row with an integer ratio; see is_reliable().
bool is_possible(const MarkRow& row, const RulerOptions& o) {
  const double fraction = row.used() < 8 ? 0.6 * o.max_residual_fraction : o.max_residual_fraction;
  return row.used() >= o.min_marks && row.residual_px < fraction * row.pitch_px && row.height_px >= 4 &&
         row.complete > kMinPossible;
}

bool is_reliable(const MarkRow& row, const RulerOptions& o) {
  const bool exact = row.used() >= 8 && row.complete > 0.5 && row.residual_px < kExact * row.pitch_px;
  return is_possible(row, o) && (row.complete > kMinComplete || row.used() >= kLongRow || exact);
}

struct Measured {
  std::vector<MarkRow> rows;      ///< best supported row for each direction and pitch
  std::vector<MarkRow> possible;  ///< as rows, for rows that are possible but not reliable
  int most_marks = 0;             ///< of any row, reliable or not
  std::vector<PeriodHint> tried;
};

void keep_best(std::vector<MarkRow>& rows, const MarkRow& row) {
  const auto existing =
      std::find_if(rows.begin(), rows.end(), [&](const MarkRow& r) { return same_row(r, row); });
  if (existing == rows.end())
    rows.push_back(row);
  else if (row.area_px > existing->area_px)
    *existing = row;
}

bool is_similar(double angle, double pitch, const PeriodHint& hint, double by_angle) {
  return direction_difference(angle, hint.angle) < by_angle && std::fabs(pitch / hint.pitch_px - 1) < 0.04;
}

Measured measure(const GrayF& picture, const RulerOptions& o) {
  Measured out;
  std::vector<PeriodHint>& tried = out.tried;
  RowMeter meter(picture);
  for (const PeriodHint& hint : find_periods(picture)) {
    // Up to three strips for each direction and pitch, because a strip may cross a label or only the ends of
    // marks; one more for a row that was already measured.
    const auto similar = std::count_if(tried.begin(), tried.end(), [&](const PeriodHint& h) {
      return is_similar(h.angle, h.pitch_px, hint, 0.02);
    });
    const bool existing = std::any_of(out.rows.begin(), out.rows.end(), [&](const MarkRow& row) {
      return is_similar(row.angle, row.pitch_px, hint, 0.2);
    });
    if (similar >= (existing ? 1 : 3)) continue;
    if (int(tried.size()) >= kMostMeasured) break;
    tried.push_back(hint);
    const auto row = meter.measure(hint);
    if (!row) continue;
    out.most_marks = std::max(out.most_marks, row->used());
    if (is_reliable(*row, o))
      keep_best(out.rows, *row);
    else if (is_possible(*row, o))
      keep_best(out.possible, *row);
  }
  return out;
}

/// Refuses the picture when finer marks were detected with more evidence but could not be measured.
void check_finest(const Measured& measured, const MarkRow& finest, const RulerOptions& o) {
  double evidence = 0;
  for (const PeriodHint& h : measured.tried)
    if (is_similar(finest.angle, finest.pitch_px, h, 0.1)) evidence = std::max(evidence, h.evidence);
  for (const PeriodHint& h : measured.tried) {
    const double ratio = finest.pitch_px / h.pitch_px;
    if (h.evidence > evidence && evidence > 0 && ratio > 1.5 &&
        std::fabs(ratio - std::round(ratio)) < 0.03 * ratio &&
        direction_difference(finest.angle, h.angle) < 0.1)
      throw Error(Errc::input, o.name,
                  fmt::format("the marks have a distance of {:.1f} px, but finer marks between them at about "
                              "{:.1f} px are too faint to be measured; use a sharper picture",
                              finest.pitch_px, h.pitch_px));
  }
}

}  // namespace

Ruler find_ruler(const GrayF& picture, const RulerOptions& options) {
  check(picture, options);
  Measured measured = measure(picture, options);
  if (measured.rows.empty()) {
    const int most = measured.most_marks;
    throw Error(
        Errc::input, options.name,
        most >= options.min_marks
            ? "no ruler detected: the periodic marks are too faint or too irregular; focus on the marks"
        : most >= 3 ? fmt::format("no ruler detected: at most {} equidistant marks in a row; at least {} are "
                                  "required; let more marks be in view",
                                  most, options.min_marks)
                    : fmt::format("no ruler detected: the picture has no periodic marks; focus on the marks, "
                                  "and let at least {} be in view",
                                  options.min_marks));
  }
  std::sort(measured.rows.begin(), measured.rows.end(),
            [](const MarkRow& a, const MarkRow& b) { return a.area_px > b.area_px; });
  const MarkRow& strongest = measured.rows.front();
  // A row at a half or a third of the pitch of the strongest row has marks at every second or third position
  // only.
  const auto finer = [&](const MarkRow& row, const MarkRow& than) {
    return row.pitch_px < 0.98 * than.pitch_px && row.complete > 1.3 * row.pitch_px / strongest.pitch_px;
  };
  const MarkRow* finest = &strongest;
  for (const MarkRow& row : measured.rows)
    if (has_integer_ratio(row, strongest, 0.02) && finer(row, *finest)) finest = &row;
  for (const MarkRow& row : measured.possible)
    if (has_integer_ratio(row, strongest, 0.005) && finer(row, *finest)) finest = &row;
  check_finest(measured, *finest, options);
  Ruler ruler;
  for (const MarkRow& row : measured.rows) {
    if (&row == finest || has_integer_ratio(*finest, row, 0.02) || has_integer_ratio(row, *finest, 0.02))
      continue;
    // Similar total length of marks; the lines of a grid have the same pitch in both directions.
    const double fraction = row.area_px / row.pitch_px / (finest->area_px / finest->pitch_px);
    if (fraction > 0.4 && row.used() >= kScaleMarks && std::fabs(row.pitch_px / finest->pitch_px - 1) > 0.02)
      throw Error(Errc::input, options.name,
                  fmt::format("the picture has two scales with mark distances of {:.2f} and {:.2f} px, which "
                              "have no integer ratio; crop it to one scale",
                              finest->pitch_px, row.pitch_px));
  }
  ruler.row = *finest;
  ruler.angle_deg = std::remainder(finest->angle, std::numbers::pi) * 180 / std::numbers::pi;
  ruler.image_width = picture.width;
  ruler.image_height = picture.height;
  return ruler;
}

}  // namespace faba
