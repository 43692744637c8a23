#pragma once
#include <vector>

namespace faba {

/// Oxygen in a round drop, as a fraction of saturation: open to air at the edge, without oxygen at t = 0.
/// Analytic solution of the diffusion equation in a cylinder (theory B5; uptake by the cells is neglected),
///   c(r,t) = 1 - 2 sum_n J0(l_n r/R) exp(-l_n^2 D t/R^2) / (l_n J1(l_n)),   J0(l_n) = 0.
class OxygenProfile {
 public:
  /// `radius` m, `diffusivity` m^2/s.
  OxygenProfile(double radius, double diffusivity);

  double concentration(double r, double t) const;  ///< r in m from the centre, t in s of exposure
  double dose(double r, double t) const;  ///< integral of the concentration from 0 to t, s at saturation
  /// Concentration at kNodes equally spaced radii 0 ... R at time t, for interpolation.
  void profile(double t, float* at_nodes) const;
  static constexpr int kNodes = 65;

 private:
  void fill_table();
  double series(double r, double t, bool integrated) const;
  struct Term {
    double root, weight;  ///< l_n and 2 / (l_n J1(l_n))
  };
  std::vector<Term> terms_;
  double radius_, rate_;      ///< rate = D / R^2
  std::vector<float> table_;  ///< kTimes rows of kNodes
};

/// Bessel functions of the first kind, x >= 0, absolute error below 1e-7. Implemented here, so that runs are
/// bitwise equal on all machines.
double bessel_j0(double x);
double bessel_j1(double x);

}  // namespace faba
