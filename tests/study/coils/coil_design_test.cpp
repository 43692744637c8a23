// What the editor of coil systems displays, compared with the functions of `faba field`, and the strength of
// the coils of the thesis (theory C8).
#include "study/coils/coil_design.h"

#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/rig_file.h"
#include "core/error.h"
#include "study/coils/field_at.h"

using namespace faba;

namespace {

const std::filesystem::path kRigs = FABA_SCENES "/../rigs";
constexpr double kPi = 3.14159265358979323846;

std::unique_ptr<Field> rig(const char* file) { return read_rig(kRigs / file, builtin_parts()).make({}); }
SwarmMotion response_of(const std::string& model) {
  const Document d = parse_toml("model = " + model, "test");
  return turning_motion(builtin_parts().model.resolve(Node(d).child("model")));
}
SwarmMotion preset(const std::string& name) {
  return response_of("{ type = 'dipole', preset = '" + name + "' }");
}
CoilDesignOptions options(const char* cells = "IT-1") {
  CoilDesignOptions o;
  o.cell = preset(cells);
  return o;
}

}  // namespace

TEST_CASE("the response of the presets is that of theory B2") {
  const SwarmMotion it1 = preset("IT-1"), msr1 = preset("MSR-1");
  CHECK(it1.turning == doctest::Approx(1.30e5).epsilon(0.005));
  CHECK(it1.diffusion == doctest::Approx(0.54).epsilon(0.01));
  CHECK(it1.speed == 186e-6);
  CHECK(msr1.turning == doctest::Approx(736).epsilon(0.005));
  CHECK_THROWS_AS((void)response_of("'basic'"), Error);
}

TEST_CASE("trap and zeros are those of `faba field null` and `faba field map`") {
  CoilDesignOptions o = options();
  o.target = {2e-3, 1e-3};
  o.polarity = -1;
  const auto four = rig("thesis-four-coils.toml");
  const CoilDesign d = coil_design(*four, o);
  const RigNull expected = null_of_rig(kRigs / "thesis-four-coils.toml", o.target, -1);
  CHECK(d.trap.current == expected.null.current);
  CHECK(d.trap.gradient == expected.null.gradient);
  CHECK(d.coils == std::vector<std::string>{"right", "top", "left", "bottom"});
  CHECK(d.zeros.empty());  // all currents of the file are zero
  REQUIRE(d.grids.size() == 1);
  CHECK(d.grids[0].size() == 33 * 33);
}

TEST_CASE("the grids: rows from the top, and the plane from the side") {
  CoilDesignOptions o = options();
  o.columns = 5;
  o.rows = 3;
  o.width = 10e-3;
  o.height = 6e-3;
  o.planes = {CoilDesignOptions::Plane::top, CoilDesignOptions::Plane::side};
  o.probe = {1e-3, 2e-3, 3e-3};
  const auto pair = read_rig(parse_toml("[[coil]]\ntype = 'loop'\nradius = '30 mm'\ncurrent = '1 A'\n"
                                        "position = ['1 mm', '2 mm', '-5 mm']\n",
                                        "test"),
                             builtin_parts())
                        .make({});
  const CoilDesign d = coil_design(*pair, o);
  const std::vector<double> current{1};
  CHECK(norm(d.grids[0][0] - pair->at({-4e-3, 2e-3, 0}, current)) < 1e-12);
  CHECK(norm(d.grids[1][14] - pair->at({4e-3, 0, -2e-3}, current)) < 1e-12);
  CHECK(d.probe == pair->at(o.probe, current));
  CHECK(d.limit == std::vector<double>{1});  // no limit in the file
}

TEST_CASE("the coils of the thesis hold IT-1 at the centre, two coils do not") {
  const HoldStrength four = coil_design(*rig("thesis-four-coils.toml"), options()).hold;
  CHECK(four.steering.met());
  CHECK(four.steering.required == doctest::Approx(20.6e-6).epsilon(0.005));  // 5 kT/m
  CHECK(four.alignment > 0.98);
  CHECK(four.trap.met());
  CHECK(four.trap.available == doctest::Approx(0.0194).epsilon(0.001));
  CHECK(four.swarm_sd == doctest::Approx(270e-6).epsilon(0.01));  // as in the guide
  const HoldStrength two = coil_design(*rig("thesis-two-coils.toml"), options()).hold;
  CHECK_FALSE(two.steering.met());
  CHECK_FALSE(two.trap.met());
  CHECK(two.u_turn == std::numeric_limits<double>::infinity());
}

TEST_CASE("the required field: alignment for IT-1, the width of a U-turn for MSR-1 in a small sample") {
  CoilDesignOptions o = options("MSR-1");
  const auto four = rig("thesis-four-coils.toml");
  const HoldStrength h = coil_design(*four, o).hold;
  CHECK(h.for_turning > h.for_alignment);
  CHECK(h.for_turning == doctest::Approx(kPi * 45e-6 / (736 * o.sample)).epsilon(0.01));
  // A U-turn in the required field is as wide as the radius of the sample.
  CHECK(h.u_turn * h.steering.available / h.for_turning == doctest::Approx(o.sample).epsilon(1e-9));
  // The mean cosine of law 1 of theory B3.
  CoilDesignOptions weak = options();
  weak.cell.diffusion = weak.cell.turning * h.steering.available / 5;
  CHECK(coil_design(*four, weak).hold.alignment == doctest::Approx(0.893383).epsilon(1e-6));
  weak.cell.diffusion = weak.cell.turning * h.steering.available / 20;
  CHECK(coil_design(*four, weak).hold.alignment == doctest::Approx(0.974671).epsilon(1e-6));
}

TEST_CASE("a position in a coil has no strength") {
  CoilDesignOptions o = options();
  o.target = {35e-3, 0};
  const CoilDesign d = coil_design(*rig("thesis-four-coils.toml"), o);
  CHECK(d.inside == "right");
  o.target = {35e-3, 5e-3};  // in the winding
  CHECK_FALSE(coil_design(*rig("thesis-four-coils.toml"), o).hold.trap.met());
}

TEST_CASE("the swarm is not trapped if a field along z tilts the cells, or the sample is too large") {
  const auto tilted = [](const char* along_z) {
    Document d = read_toml(kRigs / "thesis-four-coils.toml");
    d.root["earth"] = {{"field", {"0 T", "0 T", along_z}}};
    return coil_design(*read_rig(d, builtin_parts()).make({}), options()).hold;
  };
  // The zero in the plane is the same; at half of the radius of 1 mm it has a field of 9.7 uT.
  CHECK(tilted("9 uT").trapped());
  CHECK_FALSE(tilted("11 uT").trapped());
  CHECK(tilted("11 uT").trap.met());
  CHECK(tilted("11 uT").vertical == doctest::Approx(11e-6));
  // Steering needs a field in the plane that is at least as strong.
  CHECK(tilted("200 uT").steering.met());
  CHECK(tilted("200 uT").steering.required == doctest::Approx(200e-6));
  CHECK_FALSE(tilted("500 uT").steering.met());

  // Saddles are 9 mm from the centre, and the coils begin at 15 mm.
  CoilDesignOptions large = options();
  const auto four = rig("thesis-four-coils.toml");
  large.sample = 8e-3;
  CHECK(coil_design(*four, large).hold.trapped());
  large.sample = 12e-3;
  CHECK(coil_design(*four, large).hold.crowded);
  CHECK(coil_design(*four, large).reached.empty());
  large.sample = 20e-3;
  CHECK_FALSE(coil_design(*four, large).reached.empty());
}
