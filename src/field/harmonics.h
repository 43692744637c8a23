#pragma once
#include <span>
#include <vector>

#include "field/field_data.h"

namespace faba {

/// A magnetic field where no current flows and nothing is magnetised: the gradient of a potential that obeys
/// Laplace's equation, as a sum of solid harmonics about a centre (theory C7),
///   B = sum over l = 1..degree, m = 0..l of c_lm grad( R_lm cos ), s_lm grad( R_lm sin ),
/// in Schmidt's semi-normalisation, with lengths in units of `radius`. Its divergence and curl are zero
/// whatever the coefficients are. The first three coefficients are B_z, B_x and B_y at the centre.
struct Harmonics {
  Vec3 centre;        ///< m
  double radius = 1;  ///< m
  std::vector<double>
      coefficients;  ///< (degree + 1)^2 - 1 of them: c_l0, c_l1, s_l1, c_l2, s_l2 ... for each l

  int degree() const;
  Vec3 at(Vec3 point) const;  ///< T for coefficients in T
};

/// 224 terms: good to (distance from the centre over that of the nearest winding)^14.
constexpr int kMostHarmonicDegree = 14;
/// Number of coefficients up to a degree.
constexpr std::size_t harmonic_terms(int degree) {
  return std::size_t(degree + 1) * std::size_t(degree + 1) - 1;
}

/// The fields of all terms up to `degree` at a point (in units of the radius, from the centre): what the
/// coefficients are multiplied with. `out` has harmonic_terms(degree) elements.
void harmonic_fields(Vec3 at, int degree, std::span<Vec3> out);

/// Solid harmonics that come nearest to measurements, and how near.
struct HarmonicFit {
  Harmonics field;
  double rms = 0;        ///< of what is left over, all given components together, T
  double rms_field = 0;  ///< of the measurements themselves, T
};
/// Least squares, with the degree for which every fifth point, left out for that, is best predicted from the
/// others. Components of the field that were not given come out with the symmetry that asks for the least.
/// Throws Error(input) with fewer than 8 points, or when they lie on one line.
HarmonicFit fit_harmonics(const FieldData& data);

}  // namespace faba
