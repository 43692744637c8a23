#include "study/coils/field_at.h"

#include <fmt/format.h>

#include <cmath>

#include "app/scenario/rig_file.h"
#include "core/table.h"

namespace faba {
namespace {

std::unique_ptr<Field> rig_of(const std::filesystem::path& file) {
  return read_rig(file, builtin_parts()).make({});
}

std::string in_mm(Vec2 at) { return fmt::format("({:g}, {:g}) mm", 1e3 * at.x, 1e3 * at.y); }

}  // namespace

std::string unreachable_null(Vec2 at) {
  return fmt::format(
      "the coils cannot produce a zero of the field at {} within their current limits; choose "
      "another position with --at, or more coils",
      in_mm(at));
}

FieldAtPoints field_at_points(const std::filesystem::path& rig, const std::filesystem::path& points) {
  const auto field = rig_of(rig);
  FieldAtPoints out;
  out.current = field->default_currents();
  const Table table = read_table(points);
  const auto x = table.column("x_m"), y = table.column("y_m"), z = table.column("z_m");
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!std::isfinite(x[i] + y[i] + z[i]))
      throw Error(Errc::input, table.location(i), "a coordinate is missing");
    out.at.push_back({x[i], y[i], z[i]});
  }
  out.b.resize(out.at.size());
  field->at(out.at, out.current, out.b);
  return out;
}

FieldNull checked_null_at(const Field& field, const std::filesystem::path& rig, Vec2 at, int polarity) {
  if (!(field.clearance({at.x, at.y, 0}) > 0))
    throw Error(
        Errc::usage, rig.string(),
        fmt::format("the field at {} is unknown: the position is in a winding or outside a measured map",
                    in_mm(at)));
  FieldNull n = null_at(field, at, polarity, current_limits(field));
  if (!std::isfinite(n.gradient[0] + n.gradient[1]))
    throw Error(Errc::usage, rig.string(), fmt::format("the field at {} could not be computed", in_mm(at)));
  return n;
}

RigNull null_of_rig(const std::filesystem::path& rig, Vec2 at, int polarity) {
  const auto field = rig_of(rig);
  RigNull out;
  out.at = at;
  out.null = checked_null_at(*field, rig, at, polarity);
  const FieldNull& n = out.null;
  for (std::size_t k = 0; k < field->coils(); ++k) out.coils.push_back(field->circuit(k).name);
  out.note =
      !n.reachable ? unreachable_null(at)
      : n.saddle && (polarity > 0 ? n.gradient[0] : -n.gradient[1]) > 0
          ? "the zero repels cells along all directions: no currents within the limits make a trap"
      : n.saddle
          ? "the zero is a saddle: it attracts cells along one direction and repels them along the other"
          : "";
  return out;
}

}  // namespace faba
