#pragma once
#include <span>
#include <vector>

#include "field/field_data.h"

namespace faba {

/// A magnetic field in a region without currents or magnetised material: the gradient of a potential that
/// obeys Laplace's equation, as a sum of solid harmonics about a centre (theory C7),
///   B = sum over l = 1..degree, m = 0..l of c_lm grad( R_lm cos ), s_lm grad( R_lm sin ),
/// in Schmidt's semi-normalisation, with lengths in units of `radius`. Its divergence and curl are zero
/// for all coefficients. The first three coefficients are B_z, B_x and B_y at the centre.
struct Harmonics {
  Vec3 centre;        ///< m
  double radius = 1;  ///< m
  std::vector<double>
      coefficients;  ///< (degree + 1)^2 - 1 of them: c_l0, c_l1, s_l1, c_l2, s_l2 ... for each l

  int degree() const;
  Vec3 at(Vec3 point) const;  ///< T for coefficients in T
};

/// 224 terms: relative error (distance from the centre / distance of the nearest winding)^14.
constexpr int kMostHarmonicDegree = 14;
/// Number of coefficients up to a degree.
constexpr std::size_t harmonic_terms(int degree) {
  return std::size_t(degree + 1) * std::size_t(degree + 1) - 1;
}

/// The fields of all terms up to `degree` for coefficients of 1, at a point relative to the centre in units
/// of the radius. `out` has harmonic_terms(degree) elements.
void harmonic_fields(Vec3 at, int degree, std::span<Vec3> out);

/// A least-squares fit of solid harmonics to measurements.
struct HarmonicFit {
  Harmonics field;
  double rms = 0;        ///< of the residuals of all given components, T
  double rms_field = 0;  ///< of the measurements, T
};
/// Least-squares fit. The degree is chosen by cross-validation with one fifth of the points. Components of
/// the field that are not given follow from the minimum-norm solution. Throws Error(input) with fewer than
/// 8 points, or when they are on one line.
HarmonicFit fit_harmonics(const FieldData& data);

}  // namespace faba
