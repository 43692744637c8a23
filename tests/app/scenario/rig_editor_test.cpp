// Changes of a coil system through the roles of its keys: laws for the field of every type of coil.
#include "app/scenario/rig_editor.h"

#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/parts.h"

using namespace faba;

namespace {

const Vec3 kPosition{0.7e-3, -0.4e-3, 0.9e-3};
const std::vector<double> kCurrent{0.3};

struct Coil {
  const char *what, *table;
};
const std::vector<Coil> kCoils{
    {"a circular loop",
     R"({"type": "loop", "radius": "4 mm", "position": [1e-3, 2e-3, 0], "axis": [1, 2, 0]})"},
    {"a solenoid",
     R"({"type": "solenoid", "radius": "4 mm", "length": "9 mm", "turns": 90, "position": [0, 1e-3, 0]})"}};

RigEditor editor(const Parts& parts, const Coil& coil) {
  Document d;
  d.root = {{"type", parts.field.names_with(Trait::coil_system).front()},
            {"coil", Json::array({Json::parse(coil.table)})},
            {"earth", {{"field", {1e-5, 0, 2e-5}}}}};
  return {parts.field, parts.field.resolve(Node(d)).resolved};
}

Vec3 field_at(const RigEditor& rig, Vec3 at) { return rig.make()->at(at, kCurrent) - rig.make()->ambient(); }

// The formulas are computed in double precision and the table of a rig has 17 digits; the tolerance is for
// the rounding of moved positions.
constexpr double kRounding = 1e-12;

}  // namespace

TEST_CASE("rig editor: the field of a moved coil moves with it") {
  const Parts parts = builtin_parts();
  for (const Coil& coil : kCoils) {
    CAPTURE(coil.what);
    const RigEditor rig = editor(parts, coil);
    RigEditor moved = rig;
    const Vec3 by{0.2e-3, -0.1e-3, 0.3e-3};
    moved.move(0, by);
    const Vec3 before = field_at(rig, kPosition);
    CHECK(norm(field_at(moved, kPosition + by) - before) < kRounding * norm(before));
    CHECK(norm(field_at(moved, kPosition) - before) > 1e-3 * norm(before));
  }
}

TEST_CASE("rig editor: the strength scales the field of a coil but not the ambient field") {
  const Parts parts = builtin_parts();
  for (const Coil& coil : kCoils) {
    CAPTURE(coil.what);
    const RigEditor rig = editor(parts, coil);
    RigEditor strong = rig;
    strong.scale_strength(0, 1.5);
    const Vec3 before = field_at(rig, kPosition);
    CHECK(norm(field_at(strong, kPosition) - 1.5 * before) < kRounding * norm(before));
    strong.add_ambient({0, 3e-5, 0});
    CHECK(norm(strong.make()->ambient() - Vec3{1e-5, 3e-5, 2e-5}) < kRounding * 1e-5);
  }
}

TEST_CASE("rig editor: a tilt rotates the axis by its angle") {
  const Parts parts = builtin_parts();
  for (const Coil& coil : kCoils) {
    CAPTURE(coil.what);
    const RigEditor rig = editor(parts, coil);
    const Vec3 axis = rig.axis(0);
    const Vec3 off = std::fabs(axis.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 across = cross(axis, off);
    across = (1 / norm(across)) * across;
    RigEditor tilted = rig;
    tilted.tilt(0, 0.1, across);
    CHECK(dot(tilted.axis(0), axis) == doctest::Approx(std::cos(0.1)).epsilon(kRounding));
    CHECK(dot(tilted.axis(0), across) == doctest::Approx(std::sin(0.1)).epsilon(kRounding));
  }
}

TEST_CASE("rig editor: every type of coil declares the keys of its position, direction and strength") {
  const Parts parts = builtin_parts();
  for (const std::string& kind : parts.field.names_with(Trait::coil)) {
    CAPTURE(kind);
    const std::string schema = parts.field.json_schema(kind).dump();
    CHECK(schema.find(R"("x-role":"position")") != std::string::npos);
    CHECK(schema.find(R"("x-role":"strength")") != std::string::npos);
    const bool direction = schema.find(R"("x-role":"axis")") != std::string::npos ||
                           schema.find(R"("x-role":"turn")") != std::string::npos;
    CHECK(direction);
  }
}
