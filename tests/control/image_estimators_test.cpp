// The estimators `image` and `groups`, built from scenario parameters.
#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/parts.h"
#include "core/error.h"
#include "core/toml.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

Frame frame_of(const cells::Look& l) {
  Frame f;
  f.m_per_px = 0.9e-6;
  f.width = l.width;
  f.height = l.height;
  f.centre_image = {l.width * 0.4, l.height * 0.6};
  return f;
}

std::unique_ptr<Estimator> estimator(const std::string& toml, const Frame& frame) {
  static const Parts parts = builtin_parts();
  const Document d = parse_toml("e = " + toml + "\n", "test");
  return parts.estimator.resolve(Node(d).child("e"))
      .make(ControlContext{nullptr, Scale{}, frame, -1, 1.0 / 15, 0, {}, nullptr});
}

Observation seen(const cells::Look& l, const std::vector<Vec2>& swarm, double t, std::uint64_t seed) {
  Observation o;
  o.t = t;
  o.image = std::make_shared<const Gray8>(cells::bytes(cells::picture(l, swarm, seed)));
  return o;
}

std::vector<Vec2> blob(Vec2 at, double sd, int n, std::uint64_t seed) {
  cells::Dice dice(seed);
  std::vector<Vec2> out;
  for (int i = 0; i < n; ++i) out.push_back({at.x + sd * dice.normal(), at.y + sd * dice.normal()});
  return out;
}

}  // namespace

TEST_CASE(
    "image: centroid, dispersion, velocity in the world frame; the share decreases as the swarm leaves") {
  cells::Look l;
  const Frame frame = frame_of(l);
  const auto e = estimator("{ type = 'image' }", frame);
  std::vector<Vec2> swarm = blob({110, 80}, 15, 200, 3);
  for (Vec2& p : swarm) p.y += 0.4 * (p.x - 110);  // not along the axes
  Estimate last;
  for (int k = 0; k < 12; ++k) {
    last = e->update(seen(l, swarm, k / 15.0, std::uint64_t(k)), {});
    if (k < 11)
      for (Vec2& p : swarm) {
        p.x += 4;
        p.y += 1;
      }
  }
  const cells::Spread truth = cells::spread(swarm);
  CHECK(norm(frame.image_from_world(last.centroid) - truth.centroid) < 2);
  const double area = frame.m_per_px * frame.m_per_px;
  CHECK(std::sqrt(last.cov.xx / area / truth.cov.xx) == doctest::Approx(1).epsilon(0.05));
  CHECK(std::sqrt(last.cov.yy / area / truth.cov.yy) == doctest::Approx(1).epsilon(0.05));
  CHECK(last.cov.xy / area == doctest::Approx(-truth.cov.xy).epsilon(0.1));  // y is inverted
  CHECK(last.velocity.x == doctest::Approx(4 * 15 * frame.m_per_px).epsilon(0.15));
  CHECK(last.velocity.y == doctest::Approx(-1 * 15 * frame.m_per_px).epsilon(0.5));
  REQUIRE(last.groups.size() == 1);
  CHECK(last.groups[0].share > 0.9);
  for (int k = 12; k < 60; ++k) {
    for (Vec2& p : swarm) p.x += 6;
    last = e->update(seen(l, swarm, k / 15.0, std::uint64_t(k)), {});
  }
  CHECK(last.visible == 0);  // all out of view: the last centroid is kept
  CHECK(last.groups.empty());
  CHECK(frame.image_from_world(last.centroid).x > 280);
}

TEST_CASE("groups: two swarms in a frame are separated, and one of them is followed") {
  cells::Look l;
  const Frame frame = frame_of(l);
  for (const std::string follow : {"largest", "first"}) {
    const auto e =
        estimator("{ type = 'groups', follow = '" + follow + "', near = ['-70 um', '60 um'] }", frame);
    auto small = blob({70, 70}, 8, 70, 1), large = blob({230, 150}, 10, 160, 2);
    std::vector<Vec2> both = small;
    both.insert(both.end(), large.begin(), large.end());
    const Estimate out = e->update(seen(l, both, 0, 5), {});
    REQUIRE(out.groups.size() == 2);
    CHECK(norm(frame.image_from_world(out.groups[0].centroid) - cells::spread(large).centroid) <
          3);  // the first picture
    CHECK(norm(frame.image_from_world(out.groups[1].centroid) - cells::spread(small).centroid) < 3);
    CHECK(out.groups[0].share == doctest::Approx(160.0 / 230).epsilon(0.08));
    const Vec2 followed = cells::spread(follow == "largest" ? large : small).centroid;
    CHECK(norm(frame.image_from_world(out.centroid) - followed) < 3);
  }
}

TEST_CASE("groups: a small round swarm is round") {
  cells::Look l;
  const Frame frame = frame_of(l);
  const auto e = estimator("{ type = 'groups', count = 1 }", frame);
  const std::vector<Vec2> swarm = blob({110, 80}, 6, 400, 5);
  Estimate last;
  for (int k = 0; k < 8; ++k) last = e->update(seen(l, swarm, k / 15.0, std::uint64_t(k)), {});
  const cells::Spread truth = cells::spread(swarm);
  // Positions are binned: a 32nd of the extent of about 50 px, which loses bin^2 / 12 = 0.2 px^2 along either
  // axis; the width of a cell of 1.3 px^2 is in both.
  const double area = frame.m_per_px * frame.m_per_px;
  CHECK(last.cov.xx / last.cov.yy == doctest::Approx(truth.cov.xx / truth.cov.yy).epsilon(0.05));
  CHECK(std::sqrt(last.cov.xx / area / truth.cov.xx) == doctest::Approx(1).epsilon(0.1));
}

TEST_CASE("groups: positions are clustered when available; one swarm is one group") {
  const Frame frame;
  const auto e = estimator("'groups'", frame);
  for (const int swarms : {1, 2, 3}) {
    Observation o;
    cells::Dice dice(std::uint64_t(swarms) + 10);
    const Vec2 at[] = {{-100e-6, 0}, {90e-6, 40e-6}, {10e-6, -110e-6}};
    for (int i = 0; i < 300 * swarms; ++i) {
      const Vec2 c = at[i % swarms];
      o.seen.push_back({float(c.x + 15e-6 * dice.normal()), float(c.y + 15e-6 * dice.normal()), true});
    }
    const Estimate out = e->update(o, {});
    CHECK(int(out.groups.size()) == swarms);
    // Standard error of a mean of 300: 15 um / sqrt(300) = 0.9 um; memberships of the other groups add a
    // bias.
    double nearest = 1;
    for (const Vec2 c : at) nearest = std::min(nearest, norm(out.centroid - c));
    CHECK(nearest < 4e-6);
    CHECK(out.visible == doctest::Approx(300).epsilon(0.1));
  }
  Observation even;  // an even disc is one swarm
  cells::Dice dice(8);
  while (even.seen.size() < 1000) {
    const Vec2 p{1e-4 * (2 * dice.uniform() - 1), 1e-4 * (2 * dice.uniform() - 1)};
    if (norm(p) < 1e-4) even.seen.push_back({float(p.x), float(p.y), true});
  }
  CHECK(e->update(even, {}).groups.size() == 1);
}

TEST_CASE("missing frames and frames of a wrong size are refused; an empty observation gives no cells") {
  cells::Look l;
  Observation none;
  none.seen.push_back({});
  CHECK_THROWS_WITH_AS(estimator("'image'", frame_of(l))->update(none, {}), doctest::Contains("sensor"),
                       Error);
  CHECK_THROWS_WITH_AS(estimator("'image'", Frame{})->update(seen(l, {}, 0, 1), {}),
                       doctest::Contains("320 x 240"), Error);
  const Estimate empty = estimator("'groups'", Frame{})->update(Observation{}, {});
  CHECK(empty.visible == 0);
  CHECK(empty.groups.empty());
  const Estimate blank = estimator("'image'", frame_of(l))->update(seen(l, {}, 0, 1), {});
  CHECK(blank.visible == 0);
  CHECK(std::isfinite(blank.centroid.x));
}
