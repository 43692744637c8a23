#include "app/scenario/rig_editor.h"

#include <cmath>

namespace faba {
namespace {

// The value of the parameter with this role in a table or its subtables; null without such a parameter.
template <class MaybeConst>
MaybeConst* value_with(Role role, MaybeConst& table, const Json& schema) {
  for (const auto& [key, described] : schema.at("properties").items()) {
    if (!table.contains(key)) continue;
    if (role_of(described) == role) return &table.at(key);
    if (!described.contains("properties")) continue;
    if (MaybeConst* inside = value_with(role, table.at(key), described)) return inside;
  }
  return nullptr;
}

Vec3 vector(const Json& j) { return {in_si(j[0]), in_si(j[1]), in_si(j[2])}; }
Json json(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

}  // namespace

RigEditor::RigEditor(const FieldRegistry& fields, Json rig) : fields_(fields), rig_(std::move(rig)) {}

std::size_t RigEditor::coils() const { return rig_.at("coil").size(); }

Json RigEditor::schema_of(std::size_t coil) const {
  return fields_.json_schema(rig_.at("coil").at(coil).at("type").get<std::string>());
}

Json* RigEditor::find(std::size_t coil, Role role) {
  return value_with(role, rig_.at("coil").at(coil), schema_of(coil));
}

const Json* RigEditor::find(std::size_t coil, Role role) const {
  return value_with(role, rig_.at("coil").at(coil), schema_of(coil));
}

Vec3 RigEditor::axis(std::size_t coil) const {
  if (const Json* axis = find(coil, Role::axis)) {
    const Vec3 raw = vector(*axis);
    return (1 / norm(raw)) * raw;
  }
  const Json* turn = find(coil, Role::turn);
  const double angle = turn ? in_si(*turn) : 0;
  return {std::cos(angle), std::sin(angle), 0};
}

std::optional<Vec3> RigEditor::position(std::size_t coil) const {
  const Json* position = find(coil, Role::position);
  return position ? std::optional(vector(*position)) : std::nullopt;
}

void RigEditor::move(std::size_t coil, Vec3 by) {
  if (Json* position = find(coil, Role::position)) *position = json(vector(*position) + by);
}

void RigEditor::tilt(std::size_t coil, double angle, Vec3 across) {
  if (Json* current_axis = find(coil, Role::axis))
    *current_axis = json(std::cos(angle) * axis(coil) + std::sin(angle) * across);
  else if (Json* turn = find(coil, Role::turn))
    *turn = in_si(*turn) + angle;
}

void RigEditor::scale_strength(std::size_t coil, double factor) {
  if (Json* strength = find(coil, Role::strength)) *strength = in_si(*strength) * factor;
}

void RigEditor::add_ambient(Vec3 field) {
  const Json& schema = fields_.json_schema(rig_.at("type").get<std::string>());
  if (Json* ambient = value_with(Role::ambient, rig_, schema)) *ambient = json(vector(*ambient) + field);
}

FieldRegistry::PartType RigEditor::resolved() const {
  Document document;
  document.root = rig_;
  return fields_.resolve(Node(document));
}

}  // namespace faba
