#pragma once
#include <vector>

#include "study/quality/quality.h"
#include "vision/drop/drop_edge.h"

namespace faba {

/// Assumed. Along an arc of 30 degrees a circle departs from its chord by 3.4 % of its radius.
inline constexpr double kShortArc = 30;  ///< degrees
/// Standard errors of the radius, over the radius.
inline constexpr double kUncertainRadius = 0.03, kUselessRadius = 0.15;

/// The violated assumptions of a detected drop edge: a short arc, an uncertain radius, gaps in the edge, or a
/// blurred edge.
std::vector<Warning> drop_warnings(const DropEdge& edge);

}  // namespace faba
