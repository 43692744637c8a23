#pragma once
#include <vector>

#include "study/quality/quality.h"
#include "vision/drop/drop_edge.h"

namespace faba {

/// The violated assumptions of a detected drop edge: a short arc, an uncertain radius, gaps in the edge, or a
/// blurred edge.
std::vector<Warning> drop_warnings(const DropEdge& edge);

}  // namespace faba
