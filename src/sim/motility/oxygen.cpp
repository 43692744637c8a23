#include "sim/motility/oxygen.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/portable_math.h"

namespace faba {
namespace {

constexpr std::size_t kTerms = 60;
constexpr int kTimes = 257;
constexpr double kRelaxed = 3.0;  // in R^2/D: exp(-5.78 * 3) = 3e-8, the drop is saturated

// Power series below 12 (cancellation costs e^12/sqrt(12) ~ 5e4 ulp), Hankel's expansion above.
double bessel(double x, int order) {
  if (x < 12) {
    const double q = -x * x / 4;
    double term = order == 0 ? 1 : x / 2, sum = term;
    for (int k = 1; k < 60; ++k) sum += term *= q / (double(k) * (k + order));
    return sum;
  }
  const double mu = 4.0 * order * order;
  double p = 1, q = 0, a = 1;
  for (int k = 1; k <= 8; ++k) {  // a_k = prod (mu - (2j-1)^2) / (k! 8^k x^k)
    a *= (mu - (2.0 * k - 1) * (2.0 * k - 1)) / (k * 8.0 * x);
    if (k % 2 == 1)
      q += (k % 4 == 1 ? a : -a);
    else
      p += (k % 4 == 2 ? -a : a);
  }
  const auto s = portable::sincos(x - (0.25 + 0.5 * order) * portable::kPi);
  return std::sqrt(2 / (portable::kPi * x)) * (p * s.cos - q * s.sin);
}

}  // namespace

double bessel_j0(double x) { return bessel(x, 0); }
double bessel_j1(double x) { return bessel(x, 1); }

OxygenProfile::OxygenProfile(double radius, double diffusivity)
    : radius_(radius), rate_(diffusivity / (radius * radius)) {
  for (std::size_t n = 1; n <= kTerms; ++n) {
    double root = (double(n) - 0.25) * portable::kPi;  // McMahon; J0' = -J1
    for (int i = 0; i < 6; ++i) root += bessel_j0(root) / bessel_j1(root);
    terms_.push_back({root, 2 / (root * bessel_j1(root))});
  }
  fill_table();
}

// concentration() at all nodes; the factors that depend on position or time only are computed once.
void OxygenProfile::fill_table() {
  std::vector<double> in_space;
  for (int i = 0; i < kNodes; ++i)
    for (const Term& n : terms_)
      in_space.push_back(n.weight * bessel_j0(n.root * std::min(radius_ * i / (kNodes - 1) / radius_, 1.0)));
  table_.assign(std::size_t(kTimes) * kNodes, 0.0F);
  table_[kNodes - 1] = 1;  // at t = 0 there is oxygen at the edge only
  std::array<double, kTerms> in_time{};
  for (int j = 1; j < kTimes; ++j) {
    const double s = double(j) / (kTimes - 1),
                 t = s * s * kRelaxed / rate_;  // more nodes at the steep start
    for (std::size_t n = 0; n < kTerms; ++n)
      in_time[n] = portable::exp(-(terms_[n].root * terms_[n].root * rate_) * t);
    for (int i = 0; i < kNodes; ++i) {
      double sum = 0;
      for (std::size_t n = 0; n < kTerms; ++n) sum += in_space[std::size_t(i) * kTerms + n] * in_time[n];
      table_[std::size_t(j) * kNodes + std::size_t(i)] = float(std::clamp(1 - sum, 0.0, 1.0));
    }
  }
}

double OxygenProfile::series(double r, double t, bool integrated) const {
  double sum = 0;
  for (const Term& n : terms_) {
    const double decay = n.root * n.root * rate_, e = portable::exp(-decay * t);
    sum += n.weight * bessel_j0(n.root * std::min(r / radius_, 1.0)) * (integrated ? (1 - e) / decay : e);
  }
  return sum;
}

double OxygenProfile::concentration(double r, double t) const {
  if (t <= 0) return r >= radius_ ? 1 : 0;
  return std::clamp(1 - series(r, t, false), 0.0, 1.0);
}

double OxygenProfile::dose(double r, double t) const {
  return t <= 0 ? 0 : std::max(0.0, t - series(r, t, true));
}

void OxygenProfile::profile(double t, float* at_nodes) const {
  const double s = std::sqrt(std::clamp(t * rate_ / kRelaxed, 0.0, 1.0)) * (kTimes - 1);
  const int j = std::min(int(s), kTimes - 2);
  const auto f = float(s - j);
  const float* row = &table_[std::size_t(j) * kNodes];
  for (int i = 0; i < kNodes; ++i) at_nodes[i] = row[i] + f * (row[i + kNodes] - row[i]);
}

}  // namespace faba
