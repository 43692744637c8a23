#pragma once
#include <string>

namespace faba {

// Directions for people. Results have directions of the image frame, clockwise with y down; texts have them
// as the page and scenarios do: counter-clockwise, 0 right, 90 up.

/// Integer degrees from 0 to 359 of a direction of the image frame.
int counter_clockwise_deg(double image_deg);
/// "up and left": the nearest of eight directions.
const char* direction_name(double image_deg);
/// "90 degrees (up)".
std::string direction_text(double image_deg);
/// "90° (up)".
std::string short_direction_text(double image_deg);

}  // namespace faba
