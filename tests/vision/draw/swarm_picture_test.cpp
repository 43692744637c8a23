#include "vision/draw/swarm_picture.h"

#include <doctest/doctest.h>

#include <vector>

using namespace faba;

TEST_CASE("the picture of a swarm has the obstacles and both setpoints") {
  SwarmScene scene;
  const SwarmPicture plain(scene);
  const std::vector<std::vector<Vec2>> obstacles = {{{100, 100}, {200, 100}, {200, 200}, {100, 200}}};
  scene.obstacles = obstacles;
  scene.setpoint = Vec2{400, 240};
  scene.second_setpoint = Vec2{500, 300};
  const SwarmPicture marked(scene);
  RgbImage without, with;
  plain.draw({}, without);
  marked.draw(scene, with);
  const auto differs = [&](int x, int y) { return without.at(x, y) != with.at(x, y); };
  CHECK(differs(150, 150));  // inside
  CHECK(differs(150, 100));  // the edge
  CHECK(with.at(150, 150) != with.at(150, 100));
  CHECK_FALSE(differs(98, 150));
  CHECK_FALSE(differs(202, 202));
  CHECK(differs(400, 240));
  CHECK(with.at(500, 300) == with.at(400, 240));
}
