#pragma once
#include <Eigen/Core>
#include <vector>

#include "control/plant/motion_model.h"

namespace faba {

/// What a filter knows of the mean of a swarm.
struct MeanBelief {
  static constexpr int kSize = 7;
  using State = Eigen::Matrix<double, kSize, 1>;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  /// Position (2), m; velocity relative to the medium (2), m/s; speed relative to that of the plant (1);
  /// drift of the medium (2), m/s.
  State mean = State::Zero();
  Covariance cov = Covariance::Zero();

  Vec2 position() const { return {mean[0], mean[1]}; }
  Vec2 velocity() const { return {mean[2] + mean[5], mean[3] + mean[6]}; }
  Mat2 position_cov() const { return {cov(0, 0), cov(0, 1), cov(1, 1)}; }
  Mat2 velocity_cov() const;
};

/// Kalman filter of a swarm's mean. The plant is not linear, so beliefs are advanced by the third-degree
/// cubature rule [S64], which needs no derivatives.
class MeanFilter {
 public:
  /// Standard deviations that the filter starts with, and of the random walks of what it adapts to.
  struct Uncertainty {
    double speed = 0.2;        ///< of the relative speed at the start
    double speed_walk = 0.01;  ///< of the relative speed, 1/sqrt(s)
    double drift = 5e-6;       ///< of the drift at the start, m/s
    double drift_walk = 1e-6;  ///< m/s/sqrt(s)
    double gate = 13.8;        ///< squared normalised innovation above which a measurement is an outlier
  };
  MeanFilter(const SwarmMotion& plant, const Uncertainty& u) : plant_(plant), u_(u) {}

  bool started() const { return started_; }
  const MeanBelief& belief() const { return belief_; }
  /// Squared normalised innovation of the last measurement; its mean is 2 in a consistent filter.
  double innovation() const { return innovation_; }

  /// Advances by `time` (s) in a field `along` the direction of swimming, T, of a swarm of `cells` cells.
  void advance(Vec2 along, double time, double cells) { advance(belief_, along, time, cells); }
  /// The same for a copy, for prediction.
  void advance(MeanBelief& b, Vec2 along, double time, double cells) const;
  /// Takes a measured position, m, with the covariance of its error. The first one starts the filter. Returns
  /// false if it is an outlier, which does not change the belief; after ten of them the filter starts again.
  bool measure(Vec2 at, Mat2 cov);
  void archive(Archive& a);

 private:
  void start(Vec2 at, Mat2 cov);
  void adapt(const Eigen::Vector2d& whitened);

  SwarmMotion plant_;
  Uncertainty u_;
  MeanBelief belief_;
  bool started_ = false;
  int outliers_ = 0;  ///< in succession
  double innovation_ = 2;
  double motion_noise_ = 1, measurement_noise_ = 1;  ///< adapted factors of the variances
  Vec2 whitened_;                                    ///< normalised innovation of the last measurement
};

}  // namespace faba
