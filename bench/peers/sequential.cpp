#include "sequential.h"

#include <algorithm>

namespace faba::bench {

Sequential::Sequential(std::size_t agents, int width, int height, int noise, int hold)
    : width_(width),
      height_(height),
      hold_(hold),
      noise_(-noise, noise),
      bacteria_(agents),
      grid_(std::size_t(width) * std::size_t(height), 0) {
  std::uniform_int_distribution<int> column(0, width - 1), row(0, height - 1);
  for (Bacterium& b : bacteria_)
    for (;;) {
      const int x = column(random_), y = row(random_);
      char& cell = grid_[std::size_t(y) * std::size_t(width) + std::size_t(x)];
      if (cell) continue;
      cell = 1;
      b.x = x;
      b.y = y;
      break;
    }
  saved_ = bacteria_;
  saved_grid_ = grid_;
}

void Sequential::restore() {
  bacteria_ = saved_;
  grid_ = saved_grid_;
  iteration_ = 0;
}

void Sequential::iterate(double mx, double my) {
  const auto cell = [&](double x, double y) -> char& {
    return grid_[std::size_t(int(y + 0.5)) * std::size_t(width_) + std::size_t(int(x + 0.5))];
  };
  const bool redraw = iteration_ % hold_ == 0;
  for (Bacterium& b : bacteria_) {
    if (redraw) {
      b.vx = noise_(random_) + mx;
      b.vy = noise_(random_) + my;
    }
    const double x = std::clamp(b.x + b.vx, 0.0, double(width_ - 1));
    const double y = std::clamp(b.y + b.vy, 0.0, double(height_ - 1));
    char &here = cell(b.x, b.y), &there = cell(x, y);
    if (&there != &here && there) continue;
    here = 0;
    there = 1;
    b.x = x;
    b.y = y;
  }
  ++iteration_;
}

std::size_t Sequential::occupied() const {
  return std::size_t(std::count(grid_.begin(), grid_.end(), char{1}));
}

}  // namespace faba::bench
