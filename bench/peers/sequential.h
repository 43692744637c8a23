#pragma once
#include <cstddef>
#include <random>
#include <vector>

namespace faba::bench {

/// The rules of the published Basic model as a simple sequential program: a list of bacteria, an occupancy
/// grid, the random generator of the standard library. In px and iterations.
class Sequential {
 public:
  Sequential(std::size_t agents, int width, int height, int noise, int hold);
  void restore();
  /// One iteration; (mx, my) is the drift for velocities drawn in it.
  void iterate(double mx, double my);
  long iteration() const { return iteration_; }

  struct Bacterium {
    double x = 0, y = 0, vx = 0, vy = 0;
  };
  const std::vector<Bacterium>& bacteria() const { return bacteria_; }
  std::size_t occupied() const;

 private:
  int width_, height_, hold_;
  long iteration_ = 0;
  std::mt19937 random_{1};
  std::uniform_int_distribution<int> noise_;
  std::vector<Bacterium> bacteria_, saved_;
  std::vector<char> grid_, saved_grid_;
};

}  // namespace faba::bench
