#pragma once
#include <memory>
#include <optional>

#include "field/field.h"

namespace faba {

/// A coil system whose coils can be moved, tilted and scaled, for coils of any type: the keys are found by
/// their Role in the schema of the type.
class RigEditor {
 public:
  /// `rig` is a resolved coil system: `PartType::resolved` of read_rig().
  RigEditor(const FieldRegistry& fields, Json rig);

  std::size_t coils() const;
  /// Unit vector of the direction of the coil's field; for a coil without an axis, such as a map: x rotated
  /// about z.
  Vec3 axis(std::size_t coil) const;
  /// Position of the coil, m; empty for a coil without one.
  std::optional<Vec3> position(std::size_t coil) const;
  void move(std::size_t coil, Vec3 by);
  /// Tilts the axis by `angle` (rad) towards `across`, a unit vector perpendicular to it; a coil without an
  /// axis is rotated about z by `angle`.
  void tilt(std::size_t coil, double angle, Vec3 across);
  void scale_strength(std::size_t coil, double factor);
  void add_ambient(Vec3 field);

  /// Throws Error(usage) if a changed value is out of range.
  FieldRegistry::PartType resolved() const;
  std::unique_ptr<Field> make() const { return resolved().make({}); }

 private:
  Json schema_of(std::size_t coil) const;
  Json* find(std::size_t coil, Role role);
  const Json* find(std::size_t coil, Role role) const;
  const FieldRegistry& fields_;
  Json rig_;
};

}  // namespace faba
