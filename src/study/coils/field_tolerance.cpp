#include "study/coils/field_tolerance.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "app/scenario/rig_editor.h"
#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "core/units.h"
#include "field/null.h"
#include "study/coils/field_at.h"
#include "study/plot/plot_svg.h"

namespace faba {
namespace {

enum class Kind { current, along, across, tilt, earth };

/// A deviation of the coil system from its file, and the amounts that are tested.
struct Cause {
  Kind kind;
  const char *name, *words, *unit;
  double per_unit;  ///< SI value of `unit`
  std::vector<double> amounts;
};
const std::vector<Cause>& causes() {
  static const std::vector<Cause> all{
      {Kind::current, "current", "current of a coil changed by", "%", 0.01, {1, 2, 5, 10, 20}},
      {Kind::along, "along", "coil moved along its axis by", "mm", 1e-3, {0.1, 0.2, 0.5, 1, 2}},
      {Kind::across, "across", "coil moved across its axis by", "mm", 1e-3, {0.1, 0.2, 0.5, 1, 2}},
      {Kind::tilt, "tilt", "coil tilted by", "deg", kDegree, {0.5, 1, 2, 5, 10}},
      {Kind::earth, "earth", "ambient field changed by", "uT", 1e-6, {2, 5, 10, 18, 50}}};
  return all;
}

using Visit = std::function<void(const Field&, const std::vector<double>& current)>;

void each_current(const Field& field, double fraction, const std::vector<double>& current,
                  const Visit& visit) {
  for (std::size_t k = 0; k < current.size(); ++k)
    for (const double side : {1.0, -1.0}) {
      std::vector<double> off = current;
      off[k] *= 1 + side * fraction;
      visit(field, off);
    }
}

void each_ambient(const RigEditor& rig, double field, const std::vector<double>& current,
                  const Visit& visit) {
  for (int i = 0; i < 8; ++i) {
    RigEditor changed = rig;
    const Vec3 direction{std::cos(i * 45 * kDegree), std::sin(i * 45 * kDegree), 0};
    changed.add_ambient(field * direction);
    visit(*changed.make(), current);
  }
}

void each_pose(const RigEditor& rig, Kind kind, double amount, const std::vector<double>& current,
               const Visit& visit) {
  for (std::size_t k = 0; k < rig.coils(); ++k)
    for (const double side : {1.0, -1.0}) {
      RigEditor changed = rig;
      const Vec3 axis = rig.axis(k);
      // Across its axis in the plane of the sample, in which a zero can move.
      const Vec3 in_plane{-axis.y, axis.x, 0};
      const Vec3 across = norm(in_plane) > 1e-6 ? (1 / norm(in_plane)) * in_plane : Vec3{1, 0, 0};
      if (kind == Kind::tilt)
        changed.tilt(k, side * amount, across);
      else
        changed.move(k, (side * amount) * (kind == Kind::along ? axis : across));
      visit(*changed.make(), current);
    }
}

/// Calls visit(field, currents) for every coil and direction, or direction of the ambient field, with a
/// deviation of `amount` (SI).
void each(const Field& field, const RigEditor& rig, Kind kind, double amount,
          const std::vector<double>& current, const Visit& visit) {
  switch (kind) {
    case Kind::current:
      return each_current(field, amount, current, visit);
    case Kind::earth:
      return each_ambient(rig, amount, current, visit);
    case Kind::along:
    case Kind::across:
    case Kind::tilt:
      return each_pose(rig, kind, amount, current, visit);
  }
}

void draw(const std::filesystem::path& file, const FieldTolerance& tolerance) {
  Plot p;
  p.title = "Shift of the zero of the field";
  p.x.label = "deviation, as a fraction of the largest";
  p.y.label = "shift of the zero (mm)";
  p.y.lo = 0;
  p.width = 560;
  p.height = 340;
  for (const Cause& cause : causes()) {
    Line line;
    line.label = fmt::format("{}, up to {:g} {}", cause.name, cause.amounts.back(), cause.unit);
    line.x = {0};
    line.y = {0};
    for (const FieldTolerance::Row& row : tolerance.rows) {
      if (row.cause != cause.name || !row.shift) continue;
      line.x.push_back(row.amount / cause.amounts.back());
      line.y.push_back(*row.shift * 1e3);
    }
    line.dashed = cause.kind == Kind::across || cause.kind == Kind::tilt;
    p.add(std::move(line));
  }
  write_file(file, svg(p));
}

}  // namespace

FieldTolerance field_tolerance(const std::filesystem::path& file, Vec2 at,
                               const std::filesystem::path& picture) {
  const Parts& parts = builtin_parts();
  const auto part = read_rig(file, parts);
  const RigEditor rig(parts.field, part.resolved);
  const auto field = part.make({});
  const FieldNull n = checked_null_at(*field, file, at, 1);
  FieldTolerance out{at, n.current, n.saddle, {}, position_note(*field, n, at)};
  for (const Cause& cause : causes())
    for (const double amount : cause.amounts) {
      double worst = 0;
      each(*field, rig, cause.kind, amount * cause.per_unit, n.current,
           [&](const Field& f, const std::vector<double>& current) {
             const Vec2 now = find_null(f, current, at);
             worst = std::max(
                 worst, std::isfinite(now.x) ? norm(now - at) : std::numeric_limits<double>::infinity());
           });
      FieldTolerance::Row row{
          cause.name, fmt::format("{} {:g} {}", cause.words, amount, cause.unit), amount, cause.unit, {}};
      if (std::isfinite(worst)) row.shift = worst;
      out.rows.push_back(std::move(row));
    }
  if (!picture.empty()) draw(picture, out);
  return out;
}

}  // namespace faba
