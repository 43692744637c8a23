#include "control/plant/linear_design.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/portable_math.h"

namespace faba {
namespace {

using Matrix = Eigen::MatrixXd;
using portable::kPi;

// States of one axis: position error, velocity unless the plant is immediate, integral if there is one; in
// units of the weights, so that the numbers are of similar size.
struct Axis {
  Matrix a, b, q;
  std::vector<double> unit;
  bool has_velocity = false, has_integral = false;
};

Axis axis_of(const LinearPlant& plant, double period, const LqrWeights& w) {
  Axis x;
  x.has_velocity = !plant.immediate;
  x.has_integral = w.integral_time.has_value();
  const DiscretePlant d = discrete(plant, period);
  x.unit.push_back(w.error);
  if (x.has_velocity) x.unit.push_back(w.error / period);
  if (x.has_integral) x.unit.push_back(w.error * period);
  const auto n = Eigen::Index(x.unit.size());
  x.a = Matrix::Identity(n, n);
  x.b = Matrix::Zero(n, 1);
  x.q = Matrix::Zero(n, n);
  x.b(0, 0) = d.position_by_command / w.error;
  x.q(0, 0) = 1;
  if (x.has_velocity) {
    x.a(0, 1) = d.position_by_velocity / period;
    x.a(1, 1) = d.velocity_by_velocity;
    x.b(1, 0) = d.velocity_by_command * period / w.error;
    if (w.velocity) x.q(1, 1) = std::pow(w.error / (period * *w.velocity), 2);
  }
  if (x.has_integral) {
    x.a(n - 1, 0) = 1;
    x.q(n - 1, n - 1) = std::pow(period / *w.integral_time, 2);
  }
  return x;
}

// The structure-preserving doubling algorithm: step k has the cost of 2^k frames.
Matrix riccati(Matrix a, const Matrix& b, const Matrix& q) {
  const Matrix one = Matrix::Identity(a.rows(), a.cols());
  Matrix g = b * b.transpose(), h = q;
  for (int step = 0; step < 60; ++step) {
    const Matrix w = (one + g * h).inverse();
    const Matrix next = h + a.transpose() * h * w * a;
    g = g + a * w * g * a.transpose();
    a = a * w * a;
    const double change = (next - h).cwiseAbs().maxCoeff();
    h = (next + next.transpose()) / 2;
    if (!(change > 1e-13 * h.cwiseAbs().maxCoeff())) break;
  }
  return h;
}

std::complex<double> power(std::complex<double> z, int n) {
  std::complex<double> p = 1;
  for (int i = 0; i < n; ++i) p *= z;
  return p;
}

}  // namespace

DiscretePlant discrete(const LinearPlant& plant, double period) {
  if (plant.immediate) return {0, 0, plant.gain * period, plant.gain};
  const double x = plant.rate * period;
  const double kept = portable::exp(-x);
  // The integrals of e^(-rate t), by their series for a small rate.
  const double once = x > 1e-4 ? (1 - kept) / plant.rate : period * (1 - x / 2 + x * x / 6);
  const double twice = x > 1e-4 ? (period - once) / plant.rate : period * period * (0.5 - x / 6);
  return {once, kept, plant.gain * twice, plant.gain * once};
}

LqrDesign lqr_design(const LinearPlant& plant, double period, const LqrWeights& weights) {
  LqrDesign d;
  d.plant = plant;
  d.period = period;
  if (!(plant.gain > 0)) return d;
  const Axis x = axis_of(plant, period, weights);
  const Matrix p = riccati(x.a, x.b, x.q);
  const double cost = 1 + (x.b.transpose() * p * x.b)(0, 0);
  const Matrix k = (x.b.transpose() * p * x.a) / cost;
  d.position = k(0, 0) / x.unit[0];
  d.cost = p(0, 0) / (x.unit[0] * x.unit[0]);
  if (x.has_velocity) {
    d.velocity = k(0, 1) / x.unit[1];
    d.cost_cross = p(0, 1) / (x.unit[0] * x.unit[1]);
    d.cost_velocity = p(1, 1) / (x.unit[1] * x.unit[1]);
  }
  if (x.has_integral) d.integral = k(0, k.cols() - 1) / x.unit.back();
  const Matrix closed = x.a - x.b * k;
  const Eigen::EigenSolver<Matrix> eigen(closed, false);
  for (Eigen::Index i = 0; i < closed.rows(); ++i) d.poles.push_back(eigen.eigenvalues()[i]);
  return d;
}

// L(z) = K A^d z^-d (z - A)^-1 B / (1 + K sum_{j<d} A^j B z^-(j+1)): the predictor of the delayed state is
// part of the controller.
Margins margins_of(const LqrDesign& design, int delay) {
  const double period = design.period;
  LqrWeights w{.error = 1};
  if (design.integral != 0) w.integral_time = 1;
  const Axis x = axis_of(design.plant, period, w);
  Matrix k(1, x.a.rows());
  k(0, 0) = design.position;
  if (x.has_velocity) k(0, 1) = design.velocity / period;
  if (x.has_integral) k(0, k.cols() - 1) = design.integral * period;
  Matrix ahead = Matrix::Identity(x.a.rows(), x.a.cols());
  std::vector<double> memory;
  for (int j = 0; j < delay; ++j) {
    memory.push_back((k * ahead * x.b)(0, 0));
    ahead = x.a * ahead;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Margins m{kInfinity, kInfinity, kInfinity};
  constexpr int kFrequencies = 20000;
  std::complex<double> before = 0;
  for (int i = 1; i <= kFrequencies; ++i) {
    // Logarithmic from 1e-4 of the Nyquist frequency to it.
    const double angle = kPi * std::pow(10.0, -4.0 * (1 - double(i) / kFrequencies));
    const std::complex<double> z = std::polar(1.0, angle);
    const Eigen::MatrixXcd inverse =
        (z * Eigen::MatrixXcd::Identity(x.a.rows(), x.a.cols()) - x.a.cast<std::complex<double>>()).inverse();
    std::complex<double> inner = 1;
    for (int j = 0; j < delay; ++j) inner += memory[std::size_t(j)] / power(z, j + 1);
    const std::complex<double> loop =
        ((k * ahead).cast<std::complex<double>>() * inverse * x.b.cast<std::complex<double>>())(0, 0) /
        (power(z, delay) * inner);
    if (i > 1) {
      if (std::abs(before) >= 1 && std::abs(loop) < 1) {
        const double margin = kPi + std::arg(loop);
        m.phase = std::min(m.phase, margin);
        m.delay = std::min(m.delay, margin / angle * period);
      }
      if (before.imag() < 0 && loop.imag() >= 0 && loop.real() < 0 && loop.real() > -1)
        m.gain = std::min(m.gain, 1 / std::abs(loop.real()));
    }
    // At the Nyquist frequency the loop is real, and crosses the axis without a change of sign.
    if (i == kFrequencies && loop.real() < 0 && loop.real() > -1) m.gain = std::min(m.gain, 1 / -loop.real());
    before = loop;
  }
  return m;
}

}  // namespace faba
