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

/// Largest deviation of a mean-square displacement from a fitted law.
struct MsdMisfit {
  double lag_s = 0;
  double deviation = 0, se = 0;  ///< relative to the law; se NaN: unknown
  /// Whether it exceeds 10 % (assumed to matter), and its standard error by more than chance gives in 1 % of
  /// the videos.
  bool significant = false;
};
/// A mean-square displacement, and the law that was fitted to it at each of its lags.
struct FittedMsd {
  Msd msd;
  std::vector<double> law_px2;
};
/// Compares up to six lags between the indices `first` and `last`, spaced evenly on a logarithmic scale. The
/// values at different lags are correlated, therefore the standard error of each deviation is that of a
/// jackknife: `left_out` are the same fits with each group of tracks left out; with fewer than four nothing
/// is significant.
MsdMisfit msd_misfit(const FittedMsd& all, const std::vector<FittedMsd>& left_out, std::size_t first,
                     std::size_t last);
/// The last index of the comparison for diffusion: lags up to four times that of the last fitted one.
std::size_t last_compared(const Msd& msd, const DiffusionFit& fit);

/// The standard error from estimates that each leave out one of as many groups; NaN for fewer than four.
double jackknife_se(const std::vector<double>& estimates);

/// The fitted curves, for plots.
double diffusion_msd(const DiffusionFit& fit, double lag_s);
double persistent_msd(const PersistentFit& fit, double lag_s);

}  // namespace faba
