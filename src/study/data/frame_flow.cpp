#include "study/data/frame_flow.h"

#include <algorithm>
#include <cmath>

#include "study/data/flow_choice.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

constexpr int kLongestSide = 512;     // px, of the pictures that the flow is computed from (assumed)
constexpr int kSquare = 10;           // of these px, for an arrow (assumed)
constexpr double kLeastShift = 0.05;  // of these px per frame, mean of a square (assumed)

GrayF prepared(GrayF frame, const GreyScale& scale, int side) {
  scale.apply(frame);
  if (side == 1) return frame;
  GrayF small;
  shrink(frame, side, small);
  return small;
}

}  // namespace

std::vector<FlowArrow> flow_arrows(GrayF first, GrayF second, int bits) {
  const int longest = std::max(first.width, first.height), shortest = std::min(first.width, first.height);
  const int side = std::clamp((longest + kLongestSide - 1) / kLongestSide, 1, shortest);
  const GreyScale scale(bits, first);
  const GrayF a = prepared(std::move(first), scale, side), b = prepared(std::move(second), scale, side);
  Pool pool(1);
  Flow flow;
  flow_part(published_flow()).make({&pool})->between(a, b, flow);
  std::vector<FlowArrow> arrows;
  if (std::min(a.width, a.height) < kSquare) return arrows;
  GrayF u, v;
  shrink(flow.u, kSquare, u);
  shrink(flow.v, kSquare, v);
  const double square = kSquare * side;
  for (int row = 0; row < u.height; ++row)
    for (int col = 0; col < u.width; ++col) {
      const double du = double(u.at(col, row)), dv = double(v.at(col, row));
      if (std::hypot(du, dv) >= kLeastShift)
        arrows.push_back({square * (col + 0.5) - 0.5, square * (row + 0.5) - 0.5, du * side, dv * side});
    }
  return arrows;
}

}  // namespace faba
