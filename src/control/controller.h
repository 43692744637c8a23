#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "control/plan/plan.h"
#include "core/archive.h"
#include "core/frame.h"
#include "core/registry.h"
#include "core/signals.h"
#include "core/swarm_motion.h"
#include "field/field.h"

namespace faba {

class FieldLibrary;
struct LqrDesign;

/// Estimates the state of the swarm from observations.
class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual Estimate update(const Observation& o, const Command& last) = 0;
  virtual void archive(Archive&) {}  ///< internal state, for checkpoints
};

/// Generates the target position of the swarm.
class Reference {
 public:
  virtual ~Reference() = default;
  virtual Target update(const Estimate& e) = 0;
  virtual void archive(Archive&) {}
  /// All setpoints in order, world frame, m: for pictures and reports.
  virtual std::vector<Vec2> setpoints() const = 0;
  /// Distance within which a setpoint counts as reached, px; empty when the reference does not use one.
  virtual std::optional<double> tolerance_px() const { return std::nullopt; }
  /// Fraction of its path that the swarm has followed, 0 to 1; empty when the reference has no path.
  virtual std::optional<double> path_done() const { return std::nullopt; }
};

/// Feedback law. It receives an estimate and a target only and has no access to the simulator, a clock or a
/// device; the same object therefore controls a simulation or a real setup.
class Controller {
 public:
  virtual ~Controller() = default;
  /// `dt` is the time since the last update, s. Called once per frame. The command has one current for each
  /// coil, and all currents are finite for any estimate and target. With Trait::feedback, an estimate without
  /// cells (`visible` 0) or with a centroid that is not finite must not move the swarm: every current is
  /// zero, or with Trait::seeks_null the previous current while the target is unchanged, which keeps the zero
  /// of the field in place. Such an estimate does not change the internal state.
  virtual Command update(const Estimate& e, const Target& target, double dt) = 0;
  virtual void archive(Archive&) {}
  /// Largest field that it ever commands, T; infinity if only the limits of the coils limit it. Does not
  /// include the fields of given_currents().
  virtual double max_field() const { return std::numeric_limits<double>::infinity(); }
  /// Where it puts zeros of the field at which the swarm gathers, for these setpoints; m, world frame.
  virtual std::vector<Vec2> nulls(std::span<const Vec2> setpoints) const {
    (void)setpoints;
    return {};
  }
  /// Polygons that it keeps the mean of the swarm out of; m, world frame.
  virtual std::vector<std::vector<Vec2>> obstacles() const { return {}; }
  /// What it cannot do with its field and its parameters for these setpoints (m, world frame), in sentences;
  /// a run prints them at its start.
  virtual std::vector<std::string> notes(std::span<const Vec2> setpoints) const {
    (void)setpoints;
    return {};
  }
  /// The sets of coil currents that its parameters give directly, A; one current per coil.
  virtual std::vector<std::vector<double>> given_currents() const { return {}; }
  /// The plan of the last update, for display. Empty for a controller that does not predict, before its first
  /// update, and if the last command does not follow from a plan.
  virtual std::optional<Plan> plan() const { return std::nullopt; }
  /// The linear design of its gains, for one axis; null if it has none.
  virtual const LqrDesign* design() const { return nullptr; }
};

/// World frame, m.
struct Disc {
  Vec2 centre;
  double radius = 0;
};

/// Inputs available to the constructors of estimators, references and controllers.
struct ControlContext {
  std::shared_ptr<const Field> field;
  Scale scale;
  Frame frame;
  int polarity = -1;                     ///< of the steered cells: +1 north-seeking, -1 south-seeking
  double frame_period = 0;               ///< s
  double delay_frames = 0;               ///< from mid-exposure of a frame to the command computed from it
  std::vector<double> max_current = {};  ///< largest current of each coil, A; one per coil
  std::shared_ptr<const FieldLibrary> library = {};  ///< of the field, when the scenario specifies one
  SwarmMotion motion = {};                           ///< expected of the swarm that is steered
  std::optional<double> max_slew = {};               ///< largest change of a current, A/s
  std::optional<Disc> drop = {};                     ///< in which the cells are
};
using EstimatorRegistry = Registry<Estimator, ControlContext>;
using ReferenceRegistry = Registry<Reference, ControlContext>;
using ControllerRegistry = Registry<Controller, ControlContext>;

/// Vector from the estimated centroid to the target, px, world directions (x right, y up). NaN without a
/// target.
Vec2 error_px(const ControlContext& c, const Estimate& e, const Target& target);

/// Currents that make the cells swim along `u` (field units, world frame) at `at_world` (m): the physical
/// field is u times the field unit times the polarity (theory A8). The Earth's field is not compensated.
Command field_command(const ControlContext& c, Vec2 at_world, Vec2 u);

}  // namespace faba
