#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "tests/rendered_video.h"
#include "tests/vision/rendered_cells.h"

namespace faba {

/// Cells that swim from 1 s to 2 s only, with a gradual start and end; `spread_deg`: of their directions.
inline RenderedVideo burst(double spread_deg) {
  RenderedVideo v;
  v.fps = 30;
  v.frames = 90;
  v.microscope.cell_diameter = 4e-6;
  cells::Dice dice(5);
  std::vector<std::array<double, 3>> starts;
  for (int i = 0; i < 150; ++i)
    starts.push_back(
        {320 * dice.uniform(), 240 * dice.uniform(), spread_deg * M_PI / 180 * (dice.uniform() - 0.5)});
  v.cells = [starts](double t) {
    const double path = 15 * (1 + std::tanh((t - 1.5) / 0.25));  // px
    std::vector<CameraCell> all;
    for (const auto& [x, y, angle] : starts)
      all.push_back({float(x + path * std::cos(angle)), float(y + path * std::sin(angle))});
    return all;
  };
  return v;
}

}  // namespace faba
