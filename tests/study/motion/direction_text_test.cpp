#include "study/motion/direction_text.h"

#include <doctest/doctest.h>

using namespace faba;

TEST_CASE("directions in texts count counter-clockwise, those of the image frame clockwise") {
  CHECK(direction_text(0) == "0 degrees (right)");
  CHECK(direction_text(90) == "270 degrees (down)");
  CHECK(direction_text(-90) == "90 degrees (up)");
  CHECK(direction_text(359.8) == "0 degrees (right)");
  CHECK(short_direction_text(225.4) == "135° (up and left)");
  CHECK(short_direction_text(22) == "338° (right)");
  CHECK(short_direction_text(23) == "337° (down and right)");
}
