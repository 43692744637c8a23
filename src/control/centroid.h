#pragma once
#include "core/archive.h"
#include "core/signals.h"

namespace faba {

/// Covariance of the mean of a sample of `cells` cells with this covariance.
inline Mat2 sample_cov(Mat2 cov, double cells) { return cells > 0 ? (1 / cells) * cov : Mat2{}; }

/// Covariance of the error of a centroid from cells that only one of two successive pictures shows; `before`
/// and `now` are the covariances of the cells in them. A cell at d from the centroid of n cells moves it by
/// d / n and changes the covariance by d d^T / n, from which follows (d / n)^2 = |change| / n, with the
/// absolute eigenvalues.
Mat2 flicker_cov(Mat2 before, Mat2 now, double cells);

/// Mean, covariance (n - 1) and velocity of detections. Summed in index order by one thread, so that the
/// result is bit-identical in every run.
class Centroid {
 public:
  Estimate update(const Observation& o, bool only_visible);
  void archive(Archive& a) { a& at_& t_& has_centroid_; }

 private:
  Vec2 at_;  ///< last centroid, m, world
  double t_ = 0;
  bool has_centroid_ = false;
};

}  // namespace faba
