#include "study/coils/field_model.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

#include "core/error.h"

namespace faba {
namespace {

// A parameter is not determined when its standard error exceeds half of its natural unit (gain 1, extent of
// the points, rms field): the interval then contains any plausible value. Or when the data do not depend on
// it: the error of a forward difference is below 1e-6.
constexpr double kUndetermined = 0.5, kNoEffect = 1e-6;
constexpr double kDoubtfulResidual = 0.1;  // assumed: errors of probe and formulas are a few hundredths
constexpr int kStarts = 60;  // positions of the coils along the points, 1/20 of their extent apart

double part(Vec3 v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

struct Residuals : Eigen::DenseFunctor<double> {
  const FieldModel& model;
  explicit Residuals(const FieldModel& m)
      : DenseFunctor(int(m.parameters()), int(m.values().size())), model(m) {}
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    const std::vector<double> p = model.predicted(x);
    for (std::size_t i = 0; i < p.size(); ++i)
      r[Eigen::Index(i)] = (p[i] - model.values()[i]) / model.strength();
    return 0;
  }
};

struct Minimum {
  Eigen::VectorXd x, left;
  double sum = std::numeric_limits<double>::infinity();  ///< of squared residuals; not finite: unknown field
};

Minimum minimum_from(const FieldModel& model, Eigen::VectorXd x) {
  Residuals residuals(model);
  Eigen::NumericalDiff<Residuals> slope(residuals);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals>> lm(slope);
  Minimum m;
  lm.minimize(x);
  m.x = std::move(x);
  m.left.resize(Eigen::Index(model.values().size()));
  residuals(m.x, m.left);
  m.sum = m.left.squaredNorm();
  return m;
}

// The start with the smallest residual among positions of the coils along the points.
Minimum minimum_along_points(const FieldModel& model) {
  Residuals residuals(model);
  const std::size_t axis = model.longest_axis();
  const auto& at = model.data().at;
  double low = part(at[0], axis), high = low;
  for (const Vec3& p : at) {
    low = std::min(low, part(p, axis));
    high = std::max(high, part(p, axis));
  }
  Eigen::VectorXd best;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kStarts; ++i) {
    const double shift = low - model.extent() + (high - low + 2 * model.extent()) * i / kStarts;
    const Eigen::VectorXd x = model.linear_start(axis, shift);
    if (x.size() == 0) continue;
    Eigen::VectorXd left(Eigen::Index(model.values().size()));
    residuals(x, left);
    if (!(left.squaredNorm() < smallest)) continue;
    smallest = left.squaredNorm();
    best = x;
  }
  return best.size() == 0 ? Minimum{} : minimum_from(model, best);
}

bool on_a_line(const FieldModel& model) {
  const auto& at = model.data().at;
  return std::all_of(at.begin(), at.end(), [&](const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k)
      if (k != model.longest_axis() && part(p, k) != part(at[0], k)) return false;
    return true;
  });
}

Minimum best_minimum(const FieldModel& model) {
  Minimum near = minimum_from(model, Eigen::VectorXd::Ones(model.parameters()));
  const double n = double(model.values().size());
  const auto& fitted = model.fitted();
  const bool moves = std::any_of(fitted.begin(), fitted.end(), [&](const FieldParameter& p) {
    return p.kind == FieldParameter::shift && p.axis == model.longest_axis();
  });
  if (!moves || (!on_a_line(model) && near.sum <= n * kDoubtfulResidual * kDoubtfulResidual)) return near;
  Minimum far = minimum_along_points(model);
  // Rounding must not decide between two paths to the same minimum.
  return far.sum < (1 - 1e-6) * near.sum || !std::isfinite(near.sum) ? far : near;
}

Eigen::MatrixXd derivatives(const FieldModel& model, const Eigen::VectorXd& x) {
  Residuals residuals(model);
  Eigen::NumericalDiff<Residuals> slope(residuals);
  Eigen::MatrixXd j(Eigen::Index(model.values().size()), model.parameters());
  slope.df(x, j);
  return j;
}

}  // namespace

std::string FieldParameter::name() const {
  if (kind == gain) return "gain";
  if (kind == size) return "size";
  return fmt::format("{} {}", kind == shift ? "shift" : "offset", "xyz"[axis]);
}

PlacedField::PlacedField(const Field& field, const std::vector<Vec3>& points, Vec3 centre,
                         Evaluated evaluated)
    : field_(field),
      points_(points),
      centre_(centre),
      current_(field.default_currents()),
      evaluated_(std::move(evaluated)) {}

const std::vector<Vec3>& PlacedField::at(const CoilPlacement& placement) {
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const Entry& e) { return e.placement == placement; });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front().b;
  }
  if (kept_.size() < kKept)
    kept_.emplace_front();
  else
    kept_.splice(kept_.begin(), kept_, std::prev(kept_.end()));
  Entry& e = kept_.front();
  e.placement = placement;
  const auto& [shift, size] = placement;
  std::vector<Vec3> moved = points_;
  for (Vec3& p : moved) {
    p = p - Vec3{shift[0], shift[1], shift[2]};
    if (size != 1) p = centre_ + (1 / size) * (p - centre_);
  }
  e.b.resize(moved.size());
  field_.at(moved, current_, e.b);
  // The field of a current is inversely proportional to the dimensions of its path.
  for (Vec3& b : e.b) b = (1 / size) * (b - field_.ambient());
  if (evaluated_) evaluated_(++evaluations_);
  return e.b;
}

FieldModel::FieldModel(const Field& field, const FieldData& data, Vec3 centre,
                       const PlacedField::Evaluated& evaluated)
    : data_(data), ambient_(field.ambient()), field_(field, data.at, centre, evaluated) {
  for (std::size_t i = 0; i < data.at.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (data.given[k]) values_.push_back(part(data.b[i], k));
  for (const double v : values_) strength_ += v * v / double(values_.size());
  strength_ = std::sqrt(strength_);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(data.at.begin(), data.at.end(),
                                                 [k](Vec3 a, Vec3 b) { return part(a, k) < part(b, k); });
    const double extent = part(*high, k) - part(*low, k);
    if (extent <= extent_) continue;
    extent_ = extent;
    longest_ = k;
  }
  if (data.about_axis) longest_ = 2;
  fitted_.push_back({FieldParameter::gain, 0});
  for (const std::size_t axis : {0u, 1u, 2u})
    if (!data.about_axis || axis == 2) fitted_.push_back({FieldParameter::shift, axis});
  for (std::size_t k = 0; k < 3; ++k)
    if (data.given[k]) fitted_.push_back({FieldParameter::offset, k});
}

FieldFit::Values FieldModel::meaning(const Eigen::VectorXd& x) const { return in_units(x, 1, {1, {}, {}}); }

FieldFit::Values FieldModel::errors(const Eigen::VectorXd& se) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return in_units(se, 0, {kNone, {kNone, kNone, kNone}, {kNone, kNone, kNone}});
}

std::vector<double> FieldModel::predicted(const Eigen::VectorXd& x) const {
  const FieldFit::Values m = meaning(x);
  std::vector<double> out;
  out.reserve(values_.size());
  for (const Vec3& v : field_.at({m.shift, size_in(x)}))
    for (std::size_t k = 0; k < 3; ++k)
      if (data_.given[k]) out.push_back(m.gain * part(v, k) + part(ambient_, k) + m.offset[k]);
  return out;
}

Eigen::VectorXd FieldModel::linear_start(std::size_t axis, double shift) const {
  CoilPlacement placement;
  placement.shift[axis] = shift;
  const std::vector<Vec3>& b = field_.at(placement);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(Eigen::Index(values_.size()), 4);
  Eigen::VectorXd y(Eigen::Index(values_.size()));
  Eigen::Index row = 0;
  for (const Vec3& v : b)
    for (std::size_t k = 0; k < 3; ++k) {
      if (!data_.given[k]) continue;
      a(row, 0) = part(v, k) / strength_;
      a(row, Eigen::Index(1 + k)) = 1;
      y[row] = (values_[std::size_t(row)] - part(ambient_, k)) / strength_;
      ++row;
    }
  if (!a.allFinite()) return {};
  const Eigen::VectorXd best = a.completeOrthogonalDecomposition().solve(y);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(parameters());
  for (std::size_t i = 0; i < fitted_.size(); ++i) {
    const FieldParameter& p = fitted_[i];
    double& value = x[Eigen::Index(i)];
    if (p.kind == FieldParameter::gain)
      value = best[0];
    else if (p.kind == FieldParameter::offset)
      value = 1 + best[Eigen::Index(1 + p.axis)];
    else if (p.kind == FieldParameter::shift && p.axis == axis)
      value = 1 + shift / extent_;
  }
  return x;
}

// `m`: the values of the parameters that are not fitted.
FieldFit::Values FieldModel::in_units(const Eigen::VectorXd& x, double zero, FieldFit::Values m) const {
  Eigen::Index at = 0;
  for (const FieldParameter& p : fitted_) {
    const double value = x[at++];
    if (p.kind == FieldParameter::gain)
      m.gain = value;
    else if (p.kind == FieldParameter::shift)
      m.shift[p.axis] = (value - zero) * extent_;
    else if (p.kind == FieldParameter::offset)
      m.offset[p.axis] = (value - zero) * strength_;
  }
  return m;
}

double FieldModel::size_in(const Eigen::VectorXd& x) const {
  for (std::size_t i = 0; i < fitted_.size(); ++i)
    if (fitted_[i].kind == FieldParameter::size) return x[Eigen::Index(i)];
  return 1;
}

FieldSolution solved(const FieldModel& model, const std::string& data) {
  const auto n = Eigen::Index(model.values().size());
  const Eigen::Index p = model.parameters();
  const Minimum minimum = best_minimum(model);
  if (!std::isfinite(minimum.sum))
    throw Error(Errc::input, data,
                "has points where the field is unknown, in a coil or outside a measured map; remove them");
  const Eigen::MatrixXd j = derivatives(model, minimum.x);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeThinV);
  const double largest = svd.singularValues()[0], variance = minimum.sum / double(n - p);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  std::vector<bool> without_effect(std::size_t(p), false);
  for (Eigen::Index k = 0; k < p; ++k) {
    const double s = std::max(svd.singularValues()[k], 1e-9 * largest);
    for (Eigen::Index i = 0; i < p; ++i) {
      const double component = svd.matrixV()(i, k);
      squares[i] += variance * component * component / (s * s);
      if (s < kNoEffect * largest && std::fabs(component) > 0.1) without_effect[std::size_t(i)] = true;
    }
  }
  const Eigen::VectorXd se = squares.cwiseSqrt();
  int weak = -1;
  for (std::size_t i = 0; i < without_effect.size(); ++i) {
    const auto at = Eigen::Index(i);
    if (!without_effect[i] && se[at] < kUndetermined) continue;
    const auto better = [&](std::size_t old) {
      const FieldParameter &a = model.fitted()[i], &b = model.fitted()[old];
      return a.kind < b.kind || (a.kind == b.kind && se[at] > se[Eigen::Index(old)]);
    };
    if (weak < 0 || better(std::size_t(weak))) weak = int(i);
  }
  const bool has_effect = weak >= 0 && j.col(weak).norm() > kNoEffect * largest;
  return {minimum.x, se, std::sqrt(minimum.sum / double(n)), weak, has_effect};
}

DeterminedFit determined_fit(FieldModel& model, const std::string& data) {
  DeterminedFit d;
  d.solution = solved(model, data);
  while (d.solution.weak >= 0) {
    const auto weak = std::size_t(d.solution.weak);
    d.undetermined.push_back(model.fitted()[weak].name());
    d.degenerate = d.degenerate || d.solution.has_effect;
    model.fix(weak);
    if (model.parameters() <= 1)
      throw Error(
          Errc::input, data,
          "does not determine the position of the coils nor the background field: other positions and "
          "gains fit equally well; add points at several distances from the coils and off the axis");
    d.solution = solved(model, data);
  }
  return d;
}

FieldStep step_from(const FieldModel& model, const Eigen::VectorXd& x) {
  Residuals residuals(model);
  Eigen::VectorXd left(Eigen::Index(model.values().size()));
  residuals(x, left);
  const Eigen::MatrixXd j = derivatives(model, x);
  const auto qr = j.completeOrthogonalDecomposition();
  const Eigen::MatrixXd inverse = qr.pseudoInverse();
  const Eigen::VectorXd change = -inverse * left;
  const double variance =
      (left + j * change).squaredNorm() / double(std::max<Eigen::Index>(1, left.size() - x.size()));
  return {change, (variance * inverse.rowwise().squaredNorm()).cwiseSqrt()};
}

}  // namespace faba
