#pragma once
#include <cstddef>
#include <vector>

namespace faba {

/// Mean-square displacement against lag, as measured. All of one length.
struct Msd {
  std::vector<double> lag_s, msd_px2;
  std::vector<double> se_px2;  ///< standard errors; not positive or not a number: not known
  std::vector<double> pairs;   ///< pairs of sightings behind each value
  std::size_t size() const { return lag_s.size(); }
};

/// MSD = 4 D t + 4 s^2 (theory H3): what diffuses, seen with a localisation error s per axis.
struct DiffusionFit {
  bool good = false;
  double d_px2_s = 0;
  double offset_px2 = 0;            ///< 4 s^2; negative when motion blur outweighs the localisation error
  std::size_t first = 0, lags = 0;  ///< the lags that the fit rests on: where they begin, and how many
};

/// MSD = 2 v^2 tau^2 (t/tau - 1 + exp(-t/tau)) + 4 s^2 (theory H4): what swims at a speed v and forgets its
/// direction in a time tau.
struct PersistentFit {
  bool good = false;
  double speed_px_s = 0;  ///< root mean square
  double tau_s = 0;
  bool tau_open = false;  ///< longer than the lags can tell: tau_s is then the longest one tried
  double offset_px2 = 0;  ///< 4 s^2, not negative
};

/// Straight line by weighted least squares through `lags` values from the index `first` on. lags = 0 takes
/// the number that is best for the ratio of localisation error to displacement (Michalet and Berglund, theory
/// H3), found by repeating the fit, and four at least when first > 0. At least two values, else not good.
DiffusionFit fit_diffusion(const Msd& msd, std::size_t first = 0, std::size_t lags = 0);

/// Weighted least squares over all lags: tau by a search over four decades, v^2 and s^2, both not negative,
/// in closed form for each tau. At least four values, else not good.
PersistentFit fit_persistent(const Msd& msd);

/// Exponent alpha of MSD - offset ~ t^alpha, weighted straight line through the logarithms of the lags from
/// the index `first` on at which the MSD is over twice the offset: 1 diffusion, 2 straight motion. NaN with
/// fewer than three such lags.
double fit_exponent(const Msd& msd, double offset_px2, std::size_t first = 0);

/// The curves, for drawing.
double diffusion_msd(const DiffusionFit& fit, double lag_s);
double persistent_msd(const PersistentFit& fit, double lag_s);

}  // namespace faba
