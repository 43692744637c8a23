#include <algorithm>

#include "core/schema.h"
#include "field/field.h"

namespace faba {
namespace {

/// A uniform field: two crossed pairs of coils with concurring currents, one along x and one along y (theory
/// A6; in the view of a microscope such a pair is uniform to 0.1 %, C4).
///   B = earth + gain (I_0, I_1, 0)
/// Fails where gradients matter: far from the centre, or with opposed currents.
class Uniform final : public Field {
 public:
  struct Params {
    double gain = 0.5932e-3;
    Vec2 earth{0, 0};
    double lag = 0;
  };
  static Schema<Params> schema();
  Uniform(const Params& p, const FieldContext&) : p_(p) {}

  std::size_t coils() const override { return 2; }
  void per_ampere(std::size_t coil, std::span<const Vec3> at, std::span<Vec3> b) const override;
  void eval(const Points& at, std::span<const double> current, Vectors b) const override;
  Vec3 ambient() const override { return {p_.earth.x, p_.earth.y, 0}; }
  Circuit circuit(std::size_t coil) const override {
    Circuit c;
    c.name = coil == 0 ? "x pair" : "y pair";
    c.lag = p_.lag;
    return c;
  }
  bool varies() const override { return false; }

 private:
  Params p_;
};

Schema<Uniform::Params> Uniform::schema() {
  return Schema<Params>("uniform", "A uniform field, from one pair of coils along x and one along y")
      .add("gain", &Params::gain,
           {.unit = "T/A",
            .min = 1e-9,
            .max = 1,
            .doc = "Field per ampere of each pair",
            .source = "two coils of the reference coil system, 0.2966 mT/A each (C4)"})
      .add("earth", &Params::earth,
           {.unit = "T", .min = -1e-3, .max = 1e-3, .doc = "Ambient field in the plane of the swarm"})
      .add("lag", &Params::lag,
           {.unit = "s",
            .min = 0,
            .max = 10,
            .doc = "Time constant L/R of the coils; 0: currents follow their commands at once",
            .source = "1-10 ms is typical (C4)"})
      .validity(
          "Valid only near the centre of real coils. The field has no gradients and therefore no zeros.");
}

void Uniform::eval(const Points&, std::span<const double> current, Vectors b) const {
  std::fill(b.x.begin(), b.x.end(), float(p_.earth.x + p_.gain * current[0]));
  std::fill(b.y.begin(), b.y.end(), float(p_.earth.y + p_.gain * current[1]));
}

void Uniform::per_ampere(std::size_t coil, std::span<const Vec3>, std::span<Vec3> b) const {
  std::fill(b.begin(), b.end(), coil == 0 ? Vec3{p_.gain, 0, 0} : Vec3{0, p_.gain, 0});
}

}  // namespace

void add_uniform(FieldRegistry& r) { r.add<Uniform>(); }

}  // namespace faba
