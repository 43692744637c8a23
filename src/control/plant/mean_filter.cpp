#include "control/plant/mean_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace faba {
namespace {

using State = MeanBelief::State;
using Covariance = MeanBelief::Covariance;
constexpr int kSize = MeanBelief::kSize;
constexpr int kOutliers = 10;             // in succession, after which the filter starts again
constexpr double kLeastSpeed = 0.02;      // relative; a swarm that does not move cannot be steered
constexpr double kAdaptation = 0.03;      // per measurement: time constant of 33 frames
constexpr double kLargestFactor = 1e4;    // of the adapted variances, and 1 over it
constexpr double kLeastVariance = 1e-18;  // m^2 and m^2/s^2: keeps the covariance positive
constexpr double kPlantError = 0.1;       // assumed relative error of a modelled change of the velocity

Eigen::Matrix2d matrix(Mat2 m) {
  Eigen::Matrix2d e;
  e << m.xx, m.xy, m.xy, m.yy;
  return e;
}

State moved(const SwarmMotion& plant, const State& x, Vec2 along, double time) {
  const double factor = std::max(x[4], kLeastSpeed);
  const MeanState s = advanced(plant, factor, {{x[0], x[1]}, {x[2], x[3]}}, along, time);
  State y = x;
  y[0] = s.position.x + time * x[5];
  y[1] = s.position.y + time * x[6];
  y[2] = s.velocity.x;
  y[3] = s.velocity.y;
  return y;
}

double adapted(double factor, double change) {
  return std::clamp(factor * portable::exp(change), 1 / kLargestFactor, kLargestFactor);
}

}  // namespace

Mat2 MeanBelief::velocity_cov() const {
  const auto sum = [this](int i, int j) {
    return cov(2 + i, 2 + j) + cov(5 + i, 5 + j) + cov(2 + i, 5 + j) + cov(5 + i, 2 + j);
  };
  return {sum(0, 0), sum(0, 1), sum(1, 1)};
}

void MeanFilter::start(Vec2 at, Mat2 cov) {
  belief_ = {};
  belief_.mean << at.x, at.y, 0, 0, 1, 0, 0;
  const double speed = plant_.response == SwarmMotion::Response::turning ? plant_.speed : 0;
  belief_.cov.topLeftCorner<2, 2>() = matrix(cov);
  belief_.cov(2, 2) = belief_.cov(3, 3) = kLeastVariance + speed * speed / 2;  // any heading
  belief_.cov(4, 4) = u_.speed * u_.speed;
  belief_.cov(5, 5) = belief_.cov(6, 6) = u_.drift * u_.drift;
  whitened_ = {};
  started_ = true;
  outliers_ = 0;
  innovation_ = 2;
}

void MeanFilter::advance(MeanBelief& b, Vec2 along, double time, double cells) const {
  if (!(time > 0)) return;
  // Cubature points: the columns of the root of the covariance, times the root of the number of dimensions.
  const Covariance root = b.cov.llt().matrixL();
  const Covariance columns = std::sqrt(double(kSize)) * root;
  Eigen::Matrix<double, kSize, 2 * kSize> points;
  for (Eigen::Index i = 0; i < kSize; ++i) {
    points.col(2 * i) = moved(plant_, b.mean + columns.col(i), along, time);
    points.col(2 * i + 1) = moved(plant_, b.mean - columns.col(i), along, time);
  }
  const State before = b.mean;
  b.mean = points.rowwise().sum() / (2.0 * kSize);
  points.colwise() -= b.mean;
  b.cov = points * points.transpose() / (2.0 * kSize);

  // Diffusion of the cells, of which the mean has 1 / cells, and the error of the plant.
  const double share = motion_noise_ / std::max(cells, 1.0);
  double velocity = kLeastVariance;
  if (plant_.response == SwarmMotion::Response::turning) {
    const Vec2 change{b.mean[2] - before[2], b.mean[3] - before[3]};
    // The error of the plant is the same during a turn: it grows with the turn, not with its root.
    velocity += plant_.speed * plant_.speed * plant_.diffusion * share * time +
                motion_noise_ * kPlantError * kPlantError * plant_.speed * norm(change);
  } else {
    const Vec2 v{b.mean[2], b.mean[3]};
    velocity += 2 * plant_.spread * share / time + motion_noise_ * kPlantError * kPlantError * dot(v, v);
  }
  const bool at_once = plant_.response != SwarmMotion::Response::turning;
  for (int i = 0; i < 2; ++i) {
    b.cov(i, i) +=
        kLeastVariance + 2 * plant_.spread * share * time + velocity * time * time / (at_once ? 1 : 3);
    b.cov(2 + i, 2 + i) += velocity;
    b.cov(i, 2 + i) += velocity * time / (at_once ? 1 : 2);
    b.cov(2 + i, i) = b.cov(i, 2 + i);
    b.cov(5 + i, 5 + i) += u_.drift_walk * u_.drift_walk * time;
  }
  b.cov(4, 4) += u_.speed_walk * u_.speed_walk * time;
}

bool MeanFilter::measure(Vec2 at, Mat2 cov) {
  if (!started_ || outliers_ >= kOutliers) {
    start(at, cov);
    return true;
  }
  const Eigen::Vector2d difference(at.x - belief_.mean[0], at.y - belief_.mean[1]);
  const Eigen::Matrix2d expected = belief_.cov.topLeftCorner<2, 2>() + measurement_noise_ * matrix(cov);
  const Eigen::LLT<Eigen::Matrix2d> root(expected);
  const Eigen::Vector2d whitened = root.matrixL().solve(difference);
  innovation_ = whitened.squaredNorm();
  if (!(innovation_ <= u_.gate)) {
    ++outliers_;
    motion_noise_ = adapted(motion_noise_, kAdaptation * (u_.gate / 2 - 1));
    return false;
  }
  outliers_ = 0;
  const Eigen::Matrix<double, kSize, 2> gain = root.solve(belief_.cov.topRows<2>()).transpose();
  belief_.mean += gain * difference;
  belief_.mean[4] = std::max(belief_.mean[4], kLeastSpeed);
  // Joseph's form keeps the covariance symmetric and positive.
  Covariance keep = Covariance::Identity();
  keep.leftCols<2>() -= gain;
  belief_.cov =
      keep * belief_.cov * keep.transpose() + gain * (measurement_noise_ * matrix(cov)) * gain.transpose();
  adapt(whitened);
  return true;
}

// Both variances grow when the innovations are larger than expected. Successive innovations of one sign mean
// that the swarm moves more than expected, of opposite signs that the measurement is noisier.
void MeanFilter::adapt(const Eigen::Vector2d& whitened) {
  const double size = kAdaptation * (whitened.squaredNorm() / 2 - 1);
  const double trend = kAdaptation * (whitened_.x * whitened[0] + whitened_.y * whitened[1]) / 2;
  motion_noise_ = adapted(motion_noise_, size + trend);
  measurement_noise_ = adapted(measurement_noise_, size - trend);
  whitened_ = {whitened[0], whitened[1]};
}

void MeanFilter::archive(Archive& a) {
  a& started_& outliers_& innovation_& motion_noise_& measurement_noise_& whitened_;
  for (double& v : belief_.mean.reshaped()) a& v;
  for (double& v : belief_.cov.reshaped()) a& v;
}

}  // namespace faba
