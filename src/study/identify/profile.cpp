#include "study/identify/profile.h"

#include <nlopt.hpp>
#include <vector>

namespace faba {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMaxEvaluations = 400;  // per point of the profile

struct ProfileSearch {
  const std::function<double(const VectorXd&)>* log_likelihood;
  VectorXd u;
  Index fixed;

  double operator()(const std::vector<double>& others) {
    Index k = 0;
    for (const double x : others) {
      u[k + (k >= fixed)] = x;
      ++k;
    }
    return (*log_likelihood)(u);
  }
};

double value(const std::vector<double>& x, std::vector<double>&, void* search) {
  return (*static_cast<ProfileSearch*>(search))(x);
}

}  // namespace

Profile profile_likelihood(const std::function<double(const VectorXd&)>& log_likelihood,
                           const ParameterBox& box, const VectorXd& start, Index j, int points) {
  Profile p{VectorXd::LinSpaced(points, box.low[j], box.high[j]), VectorXd(points)};
  std::vector<double> low, high, begin;
  for (Index k = 0; k < start.size(); ++k)
    if (k != j) {
      low.push_back(box.low[k]);
      high.push_back(box.high[k]);
      begin.push_back(start[k]);
    }
  for (std::size_t k = 0; k < begin.size(); ++k) begin[k] = std::min(std::max(begin[k], low[k]), high[k]);
  for (Index i = 0; i < points; ++i) {
    ProfileSearch search{&log_likelihood, start, j};
    search.u[j] = p.u[i];
    if (begin.empty()) {
      p.log_likelihood[i] = log_likelihood(search.u);
      continue;
    }
    nlopt::opt optimiser(nlopt::LN_SBPLX, unsigned(begin.size()));
    optimiser.set_lower_bounds(low);
    optimiser.set_upper_bounds(high);
    optimiser.set_max_objective(value, &search);
    optimiser.set_maxeval(kMaxEvaluations);
    optimiser.set_xtol_abs(1e-4);
    std::vector<double> at = begin;
    optimiser.optimize(at, p.log_likelihood[i]);
  }
  p.log_likelihood.array() -= p.log_likelihood.maxCoeff();
  return p;
}

}  // namespace faba
