#include "study/coils/coil_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "study/coils/field_at.h"

namespace faba {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// m B / kT of a field in which the swarm is aligned: the mean cosine is 0.893 (theory B3, law 1).
constexpr double kAligned = 5;
constexpr int kDirections = 72;

// Mean cosine of headings in a field with k = m B / kT, I_1(k) / I_0(k), as a continued fraction (B3).
double alignment_at(double k) {
  if (!(k > 0)) return 0;
  if (k > 1e3) return 1 - 0.5 / k;
  double fraction = 0;
  for (int n = 40 + int(2 * k); n > 0; --n) fraction = 1 / (2 * n / k + fraction);
  return fraction;
}

std::vector<Vec3> grid_points(const CoilDesignOptions& o, CoilDesignOptions::Plane plane) {
  std::vector<Vec3> at;
  const auto place = [](int i, int n, double size) { return ((i + 0.5) / n - 0.5) * size; };
  for (int row = 0; row < o.rows; ++row)
    for (int column = 0; column < o.columns; ++column) {
      const double right = place(column, o.columns, o.width), up = -place(row, o.rows, o.height);
      at.push_back(plane == CoilDesignOptions::Plane::top ? Vec3{right, up, 0} : Vec3{right, 0, up});
    }
  return at;
}

Vec3 place_of(const CoilDesignOptions& o) { return {o.target.x, o.target.y, 0}; }

// Name of a coil that has a part of the sample in it.
std::string coil_in_sample(const Field& field, const CoilDesignOptions& o) {
  for (const double part : {0.5, 1.0})
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * kPi * i / kDirections, r = part * o.sample;
      std::string name =
          coil_around(field, {o.target.x + r * std::cos(angle), o.target.y + r * std::sin(angle)});
      if (!name.empty()) return name;
    }
  return "";
}

// Whether the sample contains a zero of the field besides the one at its centre.
bool has_other_zero(const Field& field, const FieldNull& trap, const CoilDesignOptions& o) {
  constexpr int kStarts = 9;
  const double width = 2 * (std::fabs(o.target.x) + o.sample),
               height = 2 * (std::fabs(o.target.y) + o.sample);
  for (const FieldMap::Zero& z : field_zeros(field, trap.current, width, height, kStarts)) {
    const double distance = std::hypot(z.at.x - o.target.x, z.at.y - o.target.y);
    if (distance > 0.02 * o.sample && distance < o.sample) return true;
  }
  return false;
}

void add_steering(HoldStrength& h, const FieldRange& range, const CoilDesignOptions& o) {
  const SwarmMotion& cell = o.cell;
  h.weakest = range.weakest();
  for (int i = 0; i < kDirections; ++i) h.around.push_back(range.along(2 * kPi * i / kDirections));
  h.for_alignment = cell.turning > 0 ? kAligned * cell.diffusion / cell.turning : kInfinity;
  h.for_turning = cell.turning > 0 ? kPi * cell.speed / (cell.turning * o.sample) : kInfinity;
  h.steering = {h.weakest.tesla, std::max(h.for_alignment, h.for_turning)};
  h.turning = cell.turning * h.weakest.tesla;
  h.alignment = cell.diffusion > 0 ? alignment_at(h.turning / cell.diffusion) : double(h.turning > 0);
  h.u_turn = h.turning > 0 ? kPi * cell.speed / h.turning : kInfinity;
}

void add_trap(HoldStrength& h, const Field& field, const FieldNull& trap, const CoilDesignOptions& o) {
  const SwarmMotion& cell = o.cell;
  const double half = o.sample / 2;
  h.trap.required = cell.turning > 0 ? cell.speed / (cell.turning * half * half) : kInfinity;
  if (!trap.reachable) return;
  h.trap.available = o.polarity > 0 ? -trap.gradient[1] : trap.gradient[0];
  h.vertical = std::fabs(field.at(place_of(o), trap.current).z);
  h.tilted = h.vertical > h.trap.available * half;
  h.crowded = !o.fast && h.trap.met() && has_other_zero(field, trap, o);
}

HoldStrength hold_strength(const Field& field, const FieldNull& trap, std::span<const double> most,
                           const CoilDesignOptions& o) {
  HoldStrength h;
  add_steering(h, FieldRange(field, place_of(o), most), o);
  const std::vector<double> off(most.size(), 0.0);
  h.steering.required = std::max(h.steering.required, std::fabs(field.at(place_of(o), off).z));
  add_trap(h, field, trap, o);
  const double slope = o.cell.turning * h.trap.available;
  h.swarm_sd = slope > 0 ? std::sqrt(o.cell.speed / slope) : kInfinity;
  return h;
}

}  // namespace

CoilDesign coil_design(const Field& field, const CoilDesignOptions& o) {
  CoilDesign d;
  for (std::size_t k = 0; k < field.coils(); ++k) d.coils.push_back(field.circuit(k).name);
  d.limit = current_limits(field);
  const std::vector<double> current = field.default_currents();
  for (const CoilDesignOptions::Plane plane : o.planes) {
    const std::vector<Vec3> at = grid_points(o, plane);
    d.grids.emplace_back(at.size());
    field.at(at, current, d.grids.back());
  }
  d.probe = field.at(o.probe, current);
  constexpr int kFastStarts = 7, kStarts = 21;
  d.zeros = field_zeros(field, current, o.width, o.height, o.fast ? kFastStarts : kStarts);
  d.inside = coil_around(field, o.target);
  d.reached = coil_in_sample(field, o);
  d.trap = null_at(field, o.target, o.polarity, d.limit);
  d.hold = hold_strength(field, d.trap, d.limit, o);
  return d;
}

SwarmMotion turning_motion(const ModelRegistry::PartType& model) {
  const SwarmMotion motion = model.make({Scale{}, Scale{}.iteration})->motion();
  if (motion.response != SwarmMotion::Response::turning)
    throw Error(Errc::usage, "model",
                fmt::format("\"{}\" has no cells that the field turns; it must be a model with a magnetic "
                            "moment, such as \"dipole\"",
                            model.type));
  return motion;
}

}  // namespace faba
