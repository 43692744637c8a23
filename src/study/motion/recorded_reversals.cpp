#include "study/motion/recorded_reversals.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "core/vec.h"
#include "study/data/run_info.h"
#include "study/data/run_video.h"
#include "study/data/series.h"

namespace faba {
namespace {

constexpr double kRecordedOn = 0.2;  // fraction of the maximum field strength

}  // namespace

std::vector<FieldReversal> recorded_reversals(const std::filesystem::path& run) {
  if (!is_run(run)) return {};
  const Series series = read_series(run / "series.csv");
  const auto t = series.find("t_s"), bx = series.find("field_x_ut"), by = series.find("field_y_ut");
  if (t.empty() || bx.empty() || by.empty()) return {};
  const double sign = read_run_info(run / "manifest.json").polarity == "south" ? -1 : 1;
  double strongest = 0;
  for (std::size_t k = 0; k < t.size(); ++k) strongest = std::max(strongest, std::hypot(bx[k], by[k]));
  std::vector<FieldReversal> reversals;
  Vec2 last;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const Vec2 b{bx[k], by[k]};
    if (!(norm(b) > kRecordedOn * strongest)) continue;
    // A row holds the field before the command of that row takes effect: the field changed directly after the
    // row before.
    if (dot(b, last) < 0) {
      const Vec2 swim = sign * Vec2{b.x, -b.y};  // y is down in pictures
      reversals.push_back({t[k - 1], std::fmod(std::atan2(swim.y, swim.x) / kDegree + 360, 360)});
    }
    last = b;
  }
  return reversals;
}

}  // namespace faba
