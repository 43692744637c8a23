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

// A zero aligns cells only where the field is larger than kT / m; closer to it they swim in random
// directions. Empty unless this distance is larger than a sample.
std::string weak_gradient_note(const FieldNull& n) {
  constexpr double kThermalEnergy = 1.380649e-23 * 298.15;  // J, at 25 C
  constexpr double kMoment = 1e-15;  // A m^2, assumed: a cell with ten crystals (theory B2)
  constexpr double kSample = 10e-3;  // m, assumed: a large drop
  const double a = std::fabs(n.gradient[0]), b = std::fabs(n.gradient[1]);
  const double gradient = n.saddle ? std::max(a, b) : std::min(a, b);
  const double field = kThermalEnergy / kMoment;
  if (field <= gradient * kSample) return "";
  return fmt::format(
      "the gradient of {:.2g} T/m is too weak to gather cells. Cells with a moment of {:g} A m^2 need more "
      "than {:.2g} uT to align with the field. The field reaches this value {:.2g} m from the zero, outside "
      "a sample of {:g} mm. Choose a position nearer to the middle of the coils, or permit larger currents",
      gradient, kMoment, 1e6 * field, field / gradient, 1e3 * kSample);
}

}  // namespace

std::string coil_around(const Field& field, Vec2 at) {
  for (std::size_t k = 0; k < field.coils(); ++k)
    if (field.encloses(k, {at.x, at.y, 0})) return field.circuit(k).name;
  return "";
}

std::string position_note(const Field& field, const FieldNull& n, Vec2 at) {
  if (const std::string coil = coil_around(field, at); !coil.empty())
    return fmt::format(
        "the position {} is inside the coil \"{}\", in its bore, winding or core; choose a "
        "position between the coils with --at",
        in_mm(at), coil);
  return weak_gradient_note(n);
}

namespace {

std::string null_note(const Field& field, const FieldNull& n, Vec2 at, int polarity) {
  if (std::string note = position_note(field, n, at); !note.empty()) return note;
  if (!n.saddle) return "";
  if ((polarity > 0 ? n.gradient[0] : -n.gradient[1]) > 0)
    return "the zero repels cells along all directions: no currents within the limits make a trap";
  return "the zero is a saddle: it attracts cells along one direction and repels them along the other";
}

}  // namespace

FieldAtPoints field_at_points(const std::filesystem::path& rig, const std::filesystem::path& points) {
  const auto field = rig_of(rig);
  FieldAtPoints out;
  out.current = field->default_currents();
  const Table table = read_table(points);
  const auto x = table.column("x_m"), y = table.column("y_m"), z = table.column("z_m");
  if (table.size() == 0)
    throw Error(Errc::input, points.string(),
                "has a header but no points; write one line per point, such as 0.001,0,0");
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
  if (!n.reachable)
    throw Error(
        Errc::usage, rig.string(),
        fmt::format("the coils cannot produce a zero of the field at {} within their current limits; choose "
                    "another position with --at, or a coil system with more independent coils",
                    in_mm(at)));
  return n;
}

RigNull null_of_rig(const std::filesystem::path& rig, Vec2 at, int polarity) {
  const auto field = rig_of(rig);
  RigNull out;
  out.at = at;
  out.null = checked_null_at(*field, rig, at, polarity);
  for (std::size_t k = 0; k < field->coils(); ++k) out.coils.push_back(field->circuit(k).name);
  out.note = null_note(*field, out.null, at, polarity);
  return out;
}

}  // namespace faba
