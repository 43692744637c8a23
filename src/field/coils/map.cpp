#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "field/coil.h"
#include "field/harmonics.h"

namespace faba {
namespace {

/// The result of the fit of a map: solid harmonics in the measured box.
struct Expansion {
  Vec3 centre, half_size;
  double radius = 1;
  double residual = 0;
  std::vector<double> coefficients;
  static Schema<Expansion> schema() {
    return Schema<Expansion>("expansion", "Solid harmonics fitted to a map (theory C7)")
        .add("centre", &Expansion::centre,
             {.unit = "m", .min = -10, .max = 10, .doc = "Centre of the harmonics and of the measured box"})
        .add(
            "half_size", &Expansion::half_size,
            {.unit = "m", .min = 0, .max = 10, .doc = "Half the width, height and depth of the measured box"})
        .add("radius", &Expansion::radius,
             {.unit = "m", .min = 1e-9, .max = 100, .doc = "Unit of length of the harmonics"})
        .add("residual", &Expansion::residual,
             {.min = 0,
              .max = 1e9,
              .doc = "Rms residual of the fit, relative to the rms of the measured field"})
        .add("coefficients", &Expansion::coefficients,
             {.min = -1e6,
              .max = 1e6,
              .doc = "T/A, Schmidt's semi-normalisation: c_l0, c_l1, s_l1, c_l2, s_l2 ... for l = 1, 2 ..."})
        .check([](const Expansion& p) -> std::string {
          const int degree = Harmonics{{}, 1, p.coefficients}.degree();
          const bool valid =
              degree >= 1 && degree <= kMostHarmonicDegree && harmonic_terms(degree) == p.coefficients.size();
          return valid ? ""
                       : fmt::format(
                             "coefficients has {} values; it must have (l + 1)^2 - 1 for a degree l "
                             "from 1 to 14: 3, 8, 15 ...",
                             p.coefficients.size());
        });
  }
};

/// A coil, with any cores, whose field was measured or computed by other software, represented by solid
/// harmonics: divergence and curl are zero, and the fit smooths measurement errors (theory C7).
/// Not valid if the measured box contains a winding or a core.
class Map final : public Field {
 public:
  struct Params {
    std::string file;
    double measured_current = 1;
    std::optional<double> radius;
    Vec3 position;
    double turn = 0;
    CircuitParams circuit;
    std::optional<Expansion> expansion;
  };
  static constexpr std::array kTraits = {Trait::coil};
  static Schema<Params> schema() {
    return Schema<Params>("map", "A measured field of a coil, or one computed by other software")
        .add("file", &Params::file,
             {.doc = "Required: CSV with x_mm, y_mm, z_mm, bx_mt, by_mt, bz_mt (or _m, _um, _t, _gauss ...; "
                     "z and bz "
                     "are optional), or HDF5 from `faba field map`; relative to the folder of the coil "
                     "system file, or to the current directory"})
        .add("measured_current", &Params::measured_current,
             {.unit = "A", .min = -1e4, .max = 1e4, .doc = "Current during the measurement"})
        .add("within", &Params::radius,
             {.unit = "m",
              .min = 1e-6,
              .max = 10,
              .doc = "Radius around the origin of the map within which points are used; default: all points"})
        .add("position", &Params::position,
             {.unit = "m",
              .min = -10,
              .max = 10,
              .doc = "Position of the origin of the map, world frame",
              .role = Role::position})
        .add("turn", &Params::turn,
             {.unit = "rad",
              .min = -100,
              .max = 100,
              .doc = "Rotation of the map about z, counterclockwise",
              .role = Role::turn})
        .include(&Params::circuit, CircuitParams::schema())
        .add("expansion", &Params::expansion, {.doc = "Result of the fit; default: computed from the file"})
        .check([](const Params& p) -> std::string {
          if (p.file.empty() && !p.expansion)
            return "key \"file\" is missing; specify a CSV or HDF5 file: file = \"map.csv\"";
          return p.measured_current == 0 ? "measured_current must not be 0" : "";
        })
        .validity(
            "Not valid in a box that contains a winding or a core. The field is extrapolated up to 5 % of "
            "the diagonal beyond the box and is NaN further out.");
  }
  static void settle(Params& p, const Node& n) {
    if (p.expansion) return;
    FieldData data = field_data(n.table(p.file));
    if (data.about_axis || !data.given[0] || !data.given[1])
      throw Error(Errc::input, data.source,
                  "a map needs the columns x, y, bx and by, and preferably z and bz, such as x_mm and bx_mt");
    if (p.radius) keep_within(data, *p.radius);
    p.expansion = expanded(data, p.measured_current);
  }

  Map(const Params& p, const FieldContext&)
      : circuit_(p.circuit),
        position_(p.position),
        turn_(portable::sincos(p.turn)),
        field_{p.expansion->centre, p.expansion->radius, p.expansion->coefficients},
        half_size_(p.expansion->half_size) {}

  std::size_t coils() const override { return 1; }
  void per_ampere(std::size_t, std::span<const Vec3> at, std::span<Vec3> b) const override {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 p = turned(at[i] - position_, -1);
      b[i] = inside(p) > 0 ? circuit_.gain * turned(field_.at(p), 1) : Vec3{kNone, kNone, kNone};
    }
  }
  Circuit circuit(std::size_t) const override { return circuit_.circuit(); }
  /// Distance to the edge of the map: the field beyond is unknown.
  double clearance(Vec3 at) const override { return std::max(0.0, inside(turned(at - position_, -1))); }
  std::vector<Stroke> outline() const override {
    Stroke box;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
      box.push_back(position_ + turned(field_.centre + Vec3{x * half_size_.x, y * half_size_.y, 0}, 1));
    return {box};
  }

 private:
  static void keep_within(FieldData& d, double radius) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < d.at.size(); ++i) {
      const Vec3 p = d.at[i];
      if (norm(p) > radius) continue;
      d.at[kept] = p;
      d.b[kept++] = d.b[i];
    }
    d.at.resize(kept);
    d.b.resize(kept);
  }
  static Expansion expanded(const FieldData& data, double measured_current) {
    constexpr double kLargestResidual = 0.05;  // assumed: the error of a Hall probe is about 1 %
    const HarmonicFit fit = fit_harmonics(data);
    Expansion e;
    e.centre = fit.field.centre;
    e.radius = fit.field.radius;
    for (const Vec3& p : data.at) {
      const Vec3 d = p - e.centre;
      e.half_size = {std::max(e.half_size.x, std::fabs(d.x)), std::max(e.half_size.y, std::fabs(d.y)),
                     std::max(e.half_size.z, std::fabs(d.z))};
    }
    e.residual = fit.rms / fit.rms_field;
    if (!(fit.rms_field > 0)) throw Error(Errc::input, data.source, "all field values are 0");
    if (!(e.residual <= kLargestResidual))
      throw Error(
          Errc::input, data.source,
          fmt::format(
              "is not a magnetic field in a region without currents: the residual of the fit is {:.2g} % rms "
              "and must be at most 5 %. Check for swapped columns, wrong signs, outliers and noise; if the "
              "map includes a part of a coil or core, use a smaller part with `within`",
              100 * e.residual));
    for (const double c : fit.field.coefficients) e.coefficients.push_back(c / measured_current);
    return e;
  }

  // Rotated about z by the map's angle (sense 1) or back (sense -1).
  Vec3 turned(Vec3 v, int sense) const {
    const double s = sense * turn_.sin;
    return {turn_.cos * v.x - s * v.y, s * v.x + turn_.cos * v.y, v.z};
  }
  // Distance to the edge of the box, extended by a tenth of `radius` on all sides, in the frame of the map,
  // m; negative outside.
  double inside(Vec3 p) const {
    const Vec3 d = p - field_.centre;
    const double margin = 0.1 * field_.radius;
    return margin + std::min({half_size_.x - std::fabs(d.x), half_size_.y - std::fabs(d.y),
                              half_size_.z - std::fabs(d.z)});
  }

  CircuitParams circuit_;
  Vec3 position_;
  portable::SinCosD turn_;
  Harmonics field_;
  Vec3 half_size_;
};

}  // namespace

void add_map(FieldRegistry& r) { r.add<Map>(); }

}  // namespace faba
