#pragma once
#include <memory>
#include <vector>

#include "core/vec.h"

namespace faba {

/// Distance to the nearest point of a polyline with at least two vertices. A target that moves in every frame
/// has as many segments as frames, so they are stored in an R-tree.
class Polyline {
 public:
  explicit Polyline(const std::vector<Vec2>& vertex);
  ~Polyline();
  double distance(Vec2 p) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace faba
