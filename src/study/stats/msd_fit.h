#pragma once
#include <cstddef>
#include <vector>

namespace faba {

/// Measured mean-square displacement against lag. All vectors have the same length.
struct Msd {
  std::vector<double> lag_s, msd_px2;
  std::vector<double> se_px2;  ///< standard errors; not positive or NaN: unknown
  std::vector<double> pairs;   ///< number of pairs of detections for each value
  std::size_t size() const { return lag_s.size(); }
};

/// MSD = 4 D t + 4 s^2 (theory H3): diffusion with a localisation error s per axis.
struct DiffusionFit {
  bool good = false;
  double d_px2_s = 0;
  double offset_px2 = 0;            ///< 4 s^2; negative when motion blur outweighs the localisation error
  std::size_t first = 0, lags = 0;  ///< index of the first fitted lag, number of fitted lags
};

/// MSD = 2 v^2 tau^2 (t/tau - 1 + exp(-t/tau)) + 4 s^2 (theory H4): persistent random walk with speed v and
/// persistence time tau.
struct PersistentFit {
  bool good = false;
  double speed_px_s = 0;  ///< root mean square
  double tau_s = 0;
  bool tau_open = false;  ///< longer than the lags can resolve: tau_s is then a lower bound
  double offset_px2 = 0;  ///< 4 s^2, not negative
};

/// Weighted least-squares line through `lags` values from index `first`. lags = 0 uses the optimal number for
/// the ratio of localisation error to displacement (Michalet and Berglund, theory H3), found by iteration,
/// and at least four when first > 0. Needs at least two values, else not good.
DiffusionFit fit_diffusion(const Msd& msd, std::size_t first = 0, std::size_t lags = 0);

/// Weighted least squares over all lags: tau by a search over four decades; v^2 and s^2, both not negative,
/// in closed form for each tau. Needs at least four values, else not good.
PersistentFit fit_persistent(const Msd& msd);

/// Exponent alpha of MSD - offset ~ t^alpha: slope of a weighted line through the logarithms, for lags from
/// index `first` whose MSD is over twice the offset. 1 is diffusion, 2 straight motion. NaN with fewer than
/// three such lags.
double fit_exponent(const Msd& msd, double offset_px2, std::size_t first = 0);

/// The fitted curves, for plots.
double diffusion_msd(const DiffusionFit& fit, double lag_s);
double persistent_msd(const PersistentFit& fit, double lag_s);

}  // namespace faba
