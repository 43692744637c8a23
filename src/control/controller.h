#pragma once
#include <memory>
#include <optional>

#include "core/archive.h"
#include "core/frame.h"
#include "core/registry.h"
#include "core/signals.h"
#include "field/field.h"

namespace faba {

class FieldLibrary;

/// Turns what was seen into what is believed.
class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual Estimate update(const Observation& o, const Command& last) = 0;
  virtual void archive(Archive&) {}  ///< its memory, for checkpoints
};

/// Says where the swarm should be.
class Reference {
 public:
  virtual ~Reference() = default;
  virtual Target update(const Estimate& e) = 0;
  virtual void archive(Archive&) {}
  /// All setpoints in order, world frame, m: for pictures and reports.
  virtual std::vector<Vec2> setpoints() const = 0;
  /// Distance within which a setpoint counts as reached, px; empty where the reference does not look at it.
  virtual std::optional<double> tolerance_px() const { return std::nullopt; }
};

/// Feedback law. It sees an estimate and a target only; it cannot reach the simulator, a clock or a device,
/// which is what lets the same object drive either.
class Controller {
 public:
  virtual ~Controller() = default;
  /// `dt` s since the last update. Called once per frame. The command has one current for each coil, and all
  /// are finite whatever the estimate and the target are. With Trait::feedback, an estimate that rests on no
  /// cells (`visible` 0) or whose centroid is not finite must not move the swarm: every current is zero, or
  /// with Trait::seeks_null that of before as long as the target is the same, which leaves the zero of the
  /// field where it is. Nor is such an estimate remembered.
  virtual Command update(const Estimate& e, const Target& target, double dt) = 0;
  virtual void archive(Archive&) {}
};

/// What estimators, references and controllers may look at when they are built.
struct ControlContext {
  std::shared_ptr<const Field> field;
  Scale scale;
  Frame frame;
  int polarity = -1;                     ///< of the cells to be steered: +1 north-seeking, -1 south-seeking
  double frame_period = 0;               ///< s
  double delay_frames = 0;               ///< from mid-exposure of a picture to the command that answers it
  std::vector<double> max_current = {};  ///< largest current of each coil, A; one per coil
  std::shared_ptr<const FieldLibrary> library = {};  ///< of the field, when the scenario names one
};
using EstimatorRegistry = Registry<Estimator, ControlContext>;
using ReferenceRegistry = Registry<Reference, ControlContext>;
using ControllerRegistry = Registry<Controller, ControlContext>;

/// From the estimated centroid to the target, px, world directions (x right, y up). Not a number without a
/// target.
Vec2 error_px(const ControlContext& c, const Estimate& e, const Target& target);

/// Currents that make the cells want to swim along `drive` (field units, world frame) at `at` (m, world): the
/// physical field is drive times the unit times polarity (theory A8), the Earth's field not counted.
Command drive_command(const ControlContext& c, Vec2 at_world, Vec2 drive);

}  // namespace faba
