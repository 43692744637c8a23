#include "study/coils/field_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <list>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

#include "app/files/field_points.h"
#include "app/scenario/rig_editor.h"
#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "core/units.h"
#include "field/field_data.h"
#include "study/plot/plot_svg.h"

namespace faba {
namespace {

constexpr double kLargeResidual = 0.1;  // assumed: errors of probe and formulas are a few hundredths
// A parameter is not determined when its standard error exceeds half of its natural unit (gain 1, size of the
// map, rms field): the interval then contains any plausible value. Or when the data do not depend on it: the
// error of a forward difference is below 1e-6.
constexpr double kUndetermined = 0.5, kNoEffect = 1e-6;

/// A fitted parameter. Parameters that the data do not determine are fixed in this order.
struct Parameter {
  enum Kind { shift, offset, gain } kind = gain;
  std::size_t axis = 0;
  std::string name() const {
    return kind == gain ? "gain" : fmt::format("{} {}", kind == shift ? "shift" : "offset", "xyz"[axis]);
  }
};

/// The field of the coils at the measured points for the last few shifts of the coils. Parameters other than
/// the shift do not change it: most evaluations of a derivative use the field of a previous one.
class ShiftedField {
 public:
  using Shift = std::array<double, 3>;
  using Evaluated = std::function<void(std::uint64_t evaluations)>;

  ShiftedField(const Field& field, const std::vector<Vec3>& points, Evaluated evaluated)
      : field_(field),
        points_(points),
        current_(field.default_currents()),
        evaluated_(std::move(evaluated)) {}

  /// B at every point, T; valid until the next call.
  const std::vector<Vec3>& at(const Shift& shift) {
    const auto known =
        std::find_if(kept_.begin(), kept_.end(), [&](const Entry& e) { return e.shift == shift; });
    if (known != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, known);
      return kept_.front().b;
    }
    if (kept_.size() < kKept)
      kept_.emplace_front();
    else
      kept_.splice(kept_.begin(), kept_, std::prev(kept_.end()));
    Entry& e = kept_.front();
    e.shift = shift;
    std::vector<Vec3> moved = points_;
    for (Vec3& p : moved) p = p - Vec3{shift[0], shift[1], shift[2]};
    e.b.resize(moved.size());
    field_.at(moved, current_, e.b);
    if (evaluated_) evaluated_(++evaluations_);
    return e.b;
  }

 private:
  static constexpr std::size_t kKept = 5;  // a shift, its three derivatives, and the next shift
  struct Entry {
    Shift shift;
    std::vector<Vec3> b;
  };
  const Field& field_;
  const std::vector<Vec3>& points_;
  std::vector<double> current_;
  Evaluated evaluated_;
  std::uint64_t evaluations_ = 0;
  std::list<Entry> kept_;  ///< the most recently used first
};

/// The measured values, and those predicted by the coil system with all fields multiplied by `gain`, the
/// coils moved by `shift`, and `offset` added.
class Model {
 public:
  Model(const Field& field, const FieldData& data, const ShiftedField::Evaluated& evaluated)
      : data_(data), ambient_(field.ambient()), field_(field, data.at, evaluated) {
    for (std::size_t i = 0; i < data.at.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (data.given[k]) values_.push_back(part(data.b[i], k));
    // Parameters are scaled to about 1: lengths by the size of the map, fields by the rms of the field.
    for (const Vec3& p : data.at) size_ = std::max({size_, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    for (const double v : values_) strength_ += v * v / double(values_.size());
    strength_ = std::sqrt(strength_);
    fitted_.push_back({Parameter::gain, 0});
    for (const std::size_t axis : {0u, 1u, 2u})
      if (!data.about_axis || axis == 2) fitted_.push_back({Parameter::shift, axis});
    for (std::size_t k = 0; k < 3; ++k)
      if (data.given[k]) fitted_.push_back({Parameter::offset, k});
  }
  const std::vector<Parameter>& fitted() const { return fitted_; }
  Eigen::Index parameters() const { return Eigen::Index(fitted_.size()); }
  /// Keeps a parameter at its value in the coil system.
  void fix(std::size_t which) { fitted_.erase(fitted_.begin() + std::ptrdiff_t(which)); }
  const std::vector<double>& values() const { return values_; }
  double strength() const { return strength_; }

  // All parameters are 1 for the coil system as in its file: forward differences use a fraction of a
  // parameter as their step.
  FieldFit::Values meaning(const Eigen::VectorXd& x) const { return in_units(x, 1, {1, {}, {}}); }
  FieldFit::Values errors(const Eigen::VectorXd& se) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return in_units(se, 0, {kNone, {kNone, kNone, kNone}, {kNone, kNone, kNone}});
  }
  std::vector<double> predicted(const Eigen::VectorXd& x) const {
    const FieldFit::Values m = meaning(x);
    std::vector<double> out;
    out.reserve(values_.size());
    for (const Vec3& v : field_.at(m.shift))
      for (std::size_t k = 0; k < 3; ++k)
        if (data_.given[k]) out.push_back(m.gain * part(v - ambient_, k) + part(ambient_, k) + m.offset[k]);
    return out;
  }

 private:
  // `m`: the values of the parameters that are not fitted.
  FieldFit::Values in_units(const Eigen::VectorXd& x, double zero, FieldFit::Values m) const {
    Eigen::Index at = 0;
    for (const Parameter& p : fitted_) {
      const double value = x[at++];
      if (p.kind == Parameter::gain)
        m.gain = value;
      else if (p.kind == Parameter::shift)
        m.shift[p.axis] = (value - zero) * size_;
      else
        m.offset[p.axis] = (value - zero) * strength_;
    }
    return m;
  }
  static double part(Vec3 v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
  const FieldData& data_;
  Vec3 ambient_;
  mutable ShiftedField field_;  ///< keeps fields that predicted() has computed
  std::vector<double> values_;
  double size_ = 1e-6, strength_ = 0;
  std::vector<Parameter> fitted_;
};

struct Residuals : Eigen::DenseFunctor<double> {
  const Model& model;
  explicit Residuals(const Model& m) : DenseFunctor(int(m.parameters()), int(m.values().size())), model(m) {}
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    const std::vector<double> p = model.predicted(x);
    for (std::size_t i = 0; i < p.size(); ++i)
      r[Eigen::Index(i)] = (p[i] - model.values()[i]) / model.strength();
    return 0;
  }
};

// The coil system with the fitted gain and position of the coils, and the fitted offset added to the Earth's
// field.
void write_rig(const std::filesystem::path& file, RigEditor rig, const FieldFit::Values& m,
               const std::string& data) {
  for (std::size_t k = 0; k < rig.coils(); ++k) {
    rig.scale_strength(k, m.gain);
    rig.move(k, {m.shift[0], m.shift[1], m.shift[2]});
  }
  rig.add_ambient({m.offset[0], m.offset[1], m.offset[2]});
  Json table = rig.resolved().resolved;
  table.erase("type");
  write_file(file, "# Fitted to " + data + " with `faba field fit`.\n" + to_toml(table));
}

void draw(const std::filesystem::path& file, const Model& model, const std::vector<double>& predicted) {
  Plot p;
  p.title = "Residuals of the fitted coil system";
  p.x.label = "measured field (mT)";
  p.y.label = "measured - fitted (mT)";
  Scatter dots;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    dots.x.push_back(1e3 * model.values()[i]);
    dots.y.push_back(1e3 * (model.values()[i] - predicted[i]));
  }
  p.add(Rule{.at = 0, .of_x = false}).add(std::move(dots));
  write_file(file, svg(p));
}

struct Solution {
  Eigen::VectorXd x, standard_error;
  double rms = 0;           ///< of the residuals, as a fraction of the rms field
  int weak = -1;            ///< index of a parameter that the data do not determine; -1: none
  bool has_effect = false;  ///< of that parameter: others have the same effect
};

// The fit of the parameters of the model.
Solution solved(const Model& model, const std::string& data) {
  const auto n = Eigen::Index(model.values().size());
  const Eigen::Index p = model.parameters();
  Residuals residuals(model);
  Eigen::NumericalDiff<Residuals> slope(residuals);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals>> lm(slope);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(p);
  lm.minimize(x);
  Eigen::VectorXd left(n);
  residuals(x, left);
  if (!left.allFinite())
    throw Error(Errc::input, data,
                "has points where the field is unknown, in a coil or outside a measured map; remove them");
  Eigen::MatrixXd j(n, p);
  slope.df(x, j);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeThinV);
  const double largest = svd.singularValues()[0], variance = left.squaredNorm() / double(n - p);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  std::vector<bool> without_effect(std::size_t(p), false);
  for (Eigen::Index k = 0; k < p; ++k) {
    const double s = std::max(svd.singularValues()[k], 1e-9 * largest);
    for (Eigen::Index i = 0; i < p; ++i) {
      const double part = svd.matrixV()(i, k);
      squares[i] += variance * part * part / (s * s);
      if (s < kNoEffect * largest && std::fabs(part) > 0.1) without_effect[std::size_t(i)] = true;
    }
  }
  const Eigen::VectorXd se = squares.cwiseSqrt();
  int weak = -1;
  for (std::size_t i = 0; i < without_effect.size(); ++i) {
    const auto at = Eigen::Index(i);
    if (!without_effect[i] && se[at] < kUndetermined) continue;
    const auto better = [&](std::size_t old) {
      const Parameter &a = model.fitted()[i], &b = model.fitted()[old];
      return a.kind < b.kind || (a.kind == b.kind && se[at] > se[Eigen::Index(old)]);
    };
    if (weak < 0 || better(std::size_t(weak))) weak = int(i);
  }
  const bool has_effect = weak >= 0 && j.col(weak).norm() > kNoEffect * largest;
  return {x, se, std::sqrt(left.squaredNorm() / double(n)), weak, has_effect};
}

// `degenerate`: a parameter was kept that has an effect, so that the others depend on its value.
std::vector<Warning> warnings_of(const FieldFit& fit, bool degenerate) {
  std::vector<Warning> out;
  const double residual = fit.rms / fit.rms_field;
  if (residual > kLargeResidual)
    out.push_back({"residual", "the coil system does not describe the measured field",
                   fmt::format("the residual is {:.0f} % of the field", 100 * residual),
                   "check the columns, the units, outliers and that the coil system is the measured one",
                   Quality::poor});
  if (fit.best.gain < 0)
    out.push_back({"direction", "the gain is negative: the direction of a current or an axis is reversed",
                   fmt::format("gain {:.3g}", fit.best.gain), "reverse the current or the axis",
                   Quality::poor});
  else if (fit.best.gain < 0.5 || fit.best.gain > 2)
    out.push_back({"gain", "the gain is far from 1", fmt::format("gain {:.3g}", fit.best.gain),
                   "check the turns, the current and the units"});
  if (!fit.undetermined.empty())
    out.push_back(
        {"points", "the measured points do not determine all parameters",
         fmt::format("{} {} kept at the value in the coil system", fmt::join(fit.undetermined, ", "),
                     fit.undetermined.size() == 1 ? "is" : "are"),
         "measure at points off the axis, and at several distances from the coils",
         degenerate ? Quality::doubtful : Quality::good});
  return out;
}

}  // namespace

FieldFit field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                   const std::filesystem::path& out, const std::filesystem::path& picture,
                   const std::function<void(std::uint64_t)>& evaluated) {
  const Parts& parts = builtin_parts();
  const auto part = read_rig(rig, parts);
  const auto field = part.make({});
  const std::vector<double> current = field->default_currents();
  if (std::all_of(current.begin(), current.end(), [](double i) { return i == 0; }))
    throw Error(Errc::usage, rig.string(),
                "all currents are zero; set the `current` of its coils to that of the measurement");
  const FieldData data = field_data(read_field_points(measured));
  Model model(*field, data, evaluated);
  const auto n = Eigen::Index(model.values().size());
  const Eigen::Index p = model.parameters();
  if (n <= p)
    throw Error(Errc::input, measured.string(),
                fmt::format("has {} values for {} parameters; at least {} are needed", n, p, p + 1));

  FieldFit fit;
  bool degenerate = false;
  Solution solution = solved(model, measured.string());
  while (solution.weak >= 0) {
    const auto weak = std::size_t(solution.weak);
    fit.undetermined.push_back(model.fitted()[weak].name());
    degenerate = degenerate || solution.has_effect;
    model.fix(weak);
    if (model.parameters() <= 1)
      throw Error(
          Errc::input, measured.string(),
          "does not determine the position of the coils nor the background field: other positions and "
          "gains fit equally well; add points at several distances from the coils and off the axis");
    solution = solved(model, measured.string());
  }
  fit.values = model.values().size();
  fit.best = model.meaning(solution.x);
  fit.standard_error = model.errors(solution.standard_error);
  fit.rms = model.strength() * solution.rms;
  fit.rms_field = model.strength();
  fit.warnings = warnings_of(fit, degenerate);
  if (!out.empty())
    write_rig(out, RigEditor(parts.field, part.resolved), fit.best, measured.filename().string());
  if (!picture.empty()) draw(picture, model, model.predicted(solution.x));
  return fit;
}

}  // namespace faba
