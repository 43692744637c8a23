#include "study/motion/direction_text.h"

#include <fmt/format.h>

#include <cmath>

namespace faba {

int counter_clockwise_deg(double image_deg) { return int(std::lround(-image_deg) % 360 + 360) % 360; }

const char* direction_name(double image_deg) {
  static const char* const kNames[] = {"right", "up and right",  "up",   "up and left",
                                       "left",  "down and left", "down", "down and right"};
  return kNames[(counter_clockwise_deg(image_deg) * 2 + 45) / 90 % 8];
}

std::string direction_text(double image_deg) {
  return fmt::format("{} degrees ({})", counter_clockwise_deg(image_deg), direction_name(image_deg));
}

std::string short_direction_text(double image_deg) {
  return fmt::format("{}° ({})", counter_clockwise_deg(image_deg), direction_name(image_deg));
}

}  // namespace faba
