#include "rig/simulated/sim_rig.h"

#include <doctest/doctest.h>

#include "tests/swarm.h"

using namespace faba;

TEST_CASE("frame 0 is the initial state; a delayed camera returns earlier frames with their times and ages") {
  for (const int delay : {0, 3}) {
    TestSwarm t("camera = { delay_frames = " + std::to_string(delay) +
                " }\n[[swarm]]\ncount = 20\nmodel = 'basic'\n");
    Rig& rig = t.simulation.loop().rig;
    std::vector<float> truth;
    for (int k = 0; k < 8; ++k) {
      Observation o;
      REQUIRE(rig.read(o));
      truth.push_back(t.column("x")[4]);
      CHECK(o.frame == std::uint64_t(k));
      CHECK(o.t == doctest::Approx((k - delay) / 15.0));
      CHECK(o.age == doctest::Approx(delay / 15.0));
      CHECK(o.seen[4].x == truth[std::size_t(std::max(0, k - delay))]);
    }
  }
}

TEST_CASE("the control loop makes the rig safe on every exit, and limits the commands of a controller") {
  TestSwarm t("limits = { max_current = '0.1 A' }\n[[swarm]]\ncount = 20\nmodel = 'basic'\n");
  struct Probe final : Sink {
    const World* world = nullptr;
    bool limited = false;
    void take(const Tick& tick) override {
      limited |= tick.limited;
      for (const double i : tick.command.current) CHECK(std::fabs(i) <= 0.1);
      if (tick.index == 5) throw Error(Errc::internal, "test", "stops here");
    }
  } probe;
  t.simulation.loop().sinks.push_back(&probe);
  t.world().command({1, 1});
  CHECK_THROWS_AS(run(t.simulation.loop(), 100, [] { return true; }), Error);
  CHECK(t.world().state().command == std::vector<double>{0, 0});
}

TEST_CASE("limits: clipping, slew rate, NaN, stale frames") {
  Limits::Params p;
  p.max_current = 1;
  p.max_slew = 2;
  Limits l(p);
  Command c{{0.5, -3}};
  CHECK(l.apply(c, 0.1, 0));
  CHECK(c.current == std::vector<double>{0.2, -0.2});
  c.current = {0.3, -0.3};
  CHECK_FALSE(l.apply(c, 0.1, 0));
  c.current = {std::nan(""), -0.3};
  CHECK(l.apply(c, 0.1, 0));
  CHECK(c.current[0] == doctest::Approx(0.1));  // towards zero, within the slew rate
  c.current = {0.1, -0.3};
  CHECK(l.apply(c, 1.0 / 15, 5));  // at once, within one camera period
  CHECK(c.current == std::vector<double>{0, 0});
}

namespace {

constexpr const char* kWithCamera = R"(
camera = { sensor = "frames", rate = "20 Hz", DELAY }
arena = { type = "drop", radius_px = 150, view_px = [320, 200], centre_px = [160, 100] }
controller = { type = "manual", field = ["1 mT", "0 T"] }
[[swarm]]
count = 60
model = { type = "dipole" }
)";

std::string with_camera(const std::string& delay) {
  std::string s = kWithCamera;
  return s.replace(s.find("DELAY"), 5, delay);
}

}  // namespace

TEST_CASE("a camera with sensor = frames gives no positions; delayed images are those of earlier frames") {
  TestSwarm now(with_camera("delay_frames = 0")), late(with_camera("delay_frames = 2"));
  std::vector<ImageRef> pictures;
  for (int k = 0; k < 6; ++k) {
    Observation a, b;
    REQUIRE(now.simulation.rig().read(a));
    REQUIRE(late.simulation.rig().read(b));
    REQUIRE(a.image);
    CHECK(a.seen.empty());
    CHECK(a.image->width == 320);
    CHECK(a.image->height == 200);
    CHECK(b.t == doctest::Approx((k - 2) / 20.0));
    CHECK(a.image == now.simulation.rig().picture());  // rendered once
    pictures.push_back(a.image);
    CHECK(b.image->px == pictures[std::size_t(std::max(0, k - 2))]->px);
    if (k > 0) CHECK(pictures[std::size_t(k)]->px != pictures[std::size_t(k - 1)]->px);
    CHECK(late.simulation.rig().picture()->px == a.image->px);  // the recorded image is not delayed
  }
}

TEST_CASE("a checkpoint contains the delayed images") {
  TestSwarm uninterrupted(with_camera("delay_frames = 3")), resumed(with_camera("delay_frames = 3"));
  Observation o;
  for (int k = 0; k < 7; ++k) REQUIRE(uninterrupted.simulation.rig().read(o));
  Archive saved;
  uninterrupted.simulation.archive(saved);
  Archive reading(saved.bytes());
  resumed.simulation.archive(reading);
  CHECK(reading.at_end());
  for (int k = 7; k < 13; ++k) {
    Observation a, b;
    REQUIRE(uninterrupted.simulation.rig().read(a));
    REQUIRE(resumed.simulation.rig().read(b));
    CHECK(a.image->px == b.image->px);
    CHECK(a.t == b.t);
  }
}

TEST_CASE("motion blur of cells is centred at their positions") {
  Frame frame;
  State s;
  s.agents = Columns(2);
  CellsInCamera camera(frame);
  s.t = 1;
  s.agents["x"][0] = 10e-6F;
  s.agents["y"][0] = 20e-6F;
  CHECK(camera.look(s, 0.01)[0].dx == 0);
  camera.remember(s);
  s.t = 1.005;
  s.agents["x"][0] = 11e-6F;
  s.agents["y"][0] = 18e-6F;
  const CameraCell c = camera.look(s, 0.02)[0];  // (200, -400) um/s, 1 um per px, y down
  CHECK(double(c.x) == doctest::Approx(frame.centre_image.x + 11));
  CHECK(double(c.y) == doctest::Approx(frame.centre_image.y - 18));
  CHECK(double(c.dx) == doctest::Approx(4).epsilon(1e-4));
  CHECK(double(c.dy) == doctest::Approx(8).epsilon(1e-4));
}

TEST_CASE("jitter: frame times are at integer steps, in order, with the given standard deviation") {
  TestSwarm t(
      "camera = { rate = \"20 Hz\", jitter = \"4 ms\", delay_frames = 1 }\nduration = 100\n"
      "[[swarm]]\ncount = 5\nmodel = 'dipole'\n");
  SimRig& rig = t.simulation.rig();
  const std::size_t n = 2000;
  const auto late = [&](std::size_t k) { return rig.time_of(k + 1) - double(k + 1) / 20; };
  const Sample s = Sample::of(n, late);
  CHECK(std::fabs(s.mean) < 5 * s.standard_error);
  CHECK(std::fabs(std::sqrt(s.variance) / 0.004 - 1) <
        5 / std::sqrt(2.0 * double(n)) + 0.01);  // plus rounding to steps of 1/4 sd
  CHECK(rig.time_of(0) == 0);
  double before = -1;
  for (std::uint64_t k = 0; k < 40; ++k) {
    Observation o;
    REQUIRE(rig.read(o));
    CHECK(t.world().state().t == doctest::Approx(rig.time_of(k)));
    CHECK(o.t > before);
    if (k > 0) {
      CHECK(o.t == doctest::Approx(rig.time_of(k - 1)));
      CHECK(o.t + o.age == doctest::Approx(rig.time_of(k)));
    }
    before = o.t;
  }
  const auto refused = [](const char* toml) { TestSwarm bad{std::string(toml)}; };
  CHECK_THROWS_AS(refused("camera = { jitter = '1 us' }\nsimulation = { step = '1 ms' }\n"
                          "[[swarm]]\nmodel = 'dipole'\n"),
                  Error);
}

TEST_CASE("estimators that need positions are refused if the camera gives none") {
  for (const char* estimator : {"mean", "visible"}) {
    const std::string toml =
        "estimator = '" + std::string(estimator) + "'\n" + with_camera("delay_frames = 0");
    try {
      TestSwarm t(toml);
      FAIL("accepted");
    } catch (const Error& e) {
      CHECK(e.code() == Errc::usage);
      CHECK(std::string(e.what()).find("use one of \"groups\", \"image\"") != std::string::npos);
    }
  }
}

TEST_CASE("a feedback controller is refused without an estimator") {
  CHECK_THROWS_AS(TestSwarm("estimator = 'none'\n[[swarm]]\nmodel = 'basic'\n"), Error);
}
