#pragma once
#include <memory>
#include <vector>

#include "core/vec.h"

namespace faba {

/// Nearest distance to a polyline of two or more vertices. A target that moves every frame has as many
/// segments as the run has frames, so they are kept in an R-tree.
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
