#pragma once
#include <memory>

#include "field/field.h"

namespace faba {

/// A coil system whose coils can be moved, tilted and made stronger, whatever kind of coil each of them is:
/// what a key means is known by its Role, which the kind's schema declares.
class RigEditor {
 public:
  /// `rig` is a resolved coil system: `PartType::resolved` of read_rig().
  RigEditor(const FieldRegistry& fields, Json rig);

  std::size_t coils() const;
  /// Direction of the coil's field, of length 1; x turned about z for a coil that has no axis, such as a map.
  Vec3 axis(std::size_t coil) const;
  void move(std::size_t coil, Vec3 by);
  /// Tilts the axis by `angle` (rad) towards `across`, of length 1 and perpendicular to it; a coil without an
  /// axis is turned about z by `angle`.
  void tilt(std::size_t coil, double angle, Vec3 across);
  void strengthen(std::size_t coil, double factor);
  void add_ambient(Vec3 field);

  /// Throws Error(usage) when a changed value is out of range.
  FieldRegistry::PartType resolved() const;
  std::unique_ptr<Field> make() const { return resolved().make({}); }

 private:
  const Json& schema_of(std::size_t coil) const;
  Json* find(std::size_t coil, Role role);
  const Json* find(std::size_t coil, Role role) const;
  const FieldRegistry& fields_;
  Json rig_;
};

}  // namespace faba
