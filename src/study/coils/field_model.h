#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "field/field.h"
#include "field/field_data.h"
#include "study/coils/field_fit_result.h"

namespace faba {

/// A fitted parameter. Parameters that the data do not determine are fixed in the order of the kinds.
struct FieldParameter {
  enum Kind { shift, size, offset, gain } kind = gain;
  std::size_t axis = 0;
  std::string name() const;
};

/// Where the coils are: moved by `shift` (m); the dimensions of a single coil multiplied by `size`.
struct CoilPlacement {
  std::array<double, 3> shift{};
  double size = 1;
  friend bool operator==(const CoilPlacement&, const CoilPlacement&) = default;
};

/// The field of the coils at the measured points for the last few placements. Other parameters do not change
/// it: most evaluations of a derivative use the field of a previous one.
class PlacedField {
 public:
  using Evaluated = std::function<void(std::uint64_t evaluations)>;
  /// `centre`: of the single coil, m.
  PlacedField(const Field& field, const std::vector<Vec3>& points, Vec3 centre, Evaluated evaluated);
  /// B at every point without the ambient field, T; valid until the next call. NaN where it is unknown.
  const std::vector<Vec3>& at(const CoilPlacement& placement);

 private:
  static constexpr std::size_t kKept = 6;  // a placement, its four derivatives, and the next placement
  struct Entry {
    CoilPlacement placement;
    std::vector<Vec3> b;
  };
  const Field& field_;
  const std::vector<Vec3>& points_;
  Vec3 centre_;
  std::vector<double> current_;
  Evaluated evaluated_;
  std::uint64_t evaluations_ = 0;
  std::list<Entry> kept_;  ///< the most recently used first
};

/// The measured values, and those predicted by the coil system with all fields multiplied by `gain`, the
/// coils moved by `shift`, and `offset` added. All parameters are 1 for the coil system as in its file:
/// forward differences use a fraction of a parameter as their step.
class FieldModel {
 public:
  FieldModel(const Field& field, const FieldData& data, Vec3 centre, const PlacedField::Evaluated& evaluated);

  const std::vector<FieldParameter>& fitted() const { return fitted_; }
  Eigen::Index parameters() const { return Eigen::Index(fitted_.size()); }
  /// Keeps a parameter at its value in the coil system.
  void fix(std::size_t which) { fitted_.erase(fitted_.begin() + std::ptrdiff_t(which)); }
  /// Fits the size of a single coil too.
  void add_size() { fitted_.push_back({FieldParameter::size, 0}); }
  /// Measured values, T.
  const std::vector<double>& values() const { return values_; }
  const FieldData& data() const { return data_; }
  /// Root mean square of the values, T.
  double strength() const { return strength_; }
  /// Largest extent of the points along an axis, m, and that axis.
  double extent() const { return extent_; }
  std::size_t longest_axis() const { return longest_; }

  FieldFit::Values meaning(const Eigen::VectorXd& x) const;
  /// NaN for parameters that are not fitted.
  FieldFit::Values errors(const Eigen::VectorXd& se) const;
  std::vector<double> predicted(const Eigen::VectorXd& x) const;
  /// Best parameters for coils moved by `shift` (m) along `axis`: gain and offsets are linear. Empty if the
  /// field is unknown at a point.
  Eigen::VectorXd linear_start(std::size_t axis, double shift) const;

 private:
  FieldFit::Values in_units(const Eigen::VectorXd& x, double zero, FieldFit::Values m) const;
  double size_in(const Eigen::VectorXd& x) const;

  const FieldData& data_;
  Vec3 ambient_;
  mutable PlacedField field_;  ///< keeps fields that predicted() has computed
  std::vector<double> values_;
  double extent_ = 1e-6, strength_ = 0;
  std::size_t longest_ = 2;
  std::vector<FieldParameter> fitted_;
};

/// Result of a least-squares fit.
struct FieldSolution {
  Eigen::VectorXd x, standard_error;
  double rms = 0;           ///< of the residuals, as a fraction of the rms field
  int weak = -1;            ///< index of a parameter that the data do not determine; -1: none
  bool has_effect = false;  ///< of that parameter: others have the same effect
};
/// Fits the parameters of the model, from the coil system as in its file and, for points on a line and for a
/// poor fit, from the best position along the points. `data`: file name. Throws Error(input).
FieldSolution solved(const FieldModel& model, const std::string& data);
/// The fit of the parameters that the data determine; the model keeps the others at their values.
struct DeterminedFit {
  FieldSolution solution;
  std::vector<std::string> undetermined;
  bool degenerate = false;  ///< a parameter was kept that has an effect: the others depend on its value
};
DeterminedFit determined_fit(FieldModel& model, const std::string& data);
/// The change of each parameter of one Gauss-Newton step from x, and its standard error.
struct FieldStep {
  Eigen::VectorXd change, standard_error;
};
FieldStep step_from(const FieldModel& model, const Eigen::VectorXd& x);

}  // namespace faba
