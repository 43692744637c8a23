#include "study/motion/flow_histograms.h"

#include <cmath>

#include "core/units.h"

namespace faba {
namespace {

/// Tests flows for the threshold and the direction.
struct Gate {
  float least, c, s, cosine;
  explicit Gate(const FlowFilter& f)
      : least(float(f.threshold_px * f.threshold_px)),
        c(float(std::cos(f.direction_deg * kDegree))),
        s(float(std::sin(f.direction_deg * kDegree))),
        cosine(float(std::cos(45 * kDegree))) {}
  bool counts(float u, float v) const { return u * u + v * v > least; }
  bool in_direction(float u, float v) const { return u * c + v * s >= cosine * std::sqrt(u * u + v * v); }
};

}  // namespace

void flow_histograms(const Flow& flow, const FlowFilter& filter, double scale, FlowHistograms& out) {
  const auto w = std::size_t(flow.width()), h = std::size_t(flow.height());
  for (auto* columns : {&out.x, &out.right, &out.left}) columns->assign(w, 0.0);
  for (auto* rows : {&out.y, &out.down, &out.up}) rows->assign(h, 0.0);
  const Gate gate(filter);
  for (std::size_t r = 0; r < h; ++r)
    for (std::size_t c = 0; c < w; ++c) {
      const float u = flow.u.px[r * w + c], v = flow.v.px[r * w + c];
      if (!gate.counts(u, v)) continue;
      const double a = double(u) * scale, b = double(v) * scale;
      (a > 0 ? out.right : out.left)[c] += std::fabs(a);
      (b > 0 ? out.down : out.up)[r] += std::fabs(b);
      if (!gate.in_direction(u, v)) continue;
      out.x[c] += std::fabs(a);
      out.y[r] += std::fabs(b);
    }
}

Flow filtered_flow(const Flow& flow, const FlowFilter& filter) {
  Flow kept = flow;
  const Gate gate(filter);
  for (std::size_t i = 0; i < kept.u.px.size(); ++i)
    if (!gate.counts(kept.u.px[i], kept.v.px[i]) || !gate.in_direction(kept.u.px[i], kept.v.px[i]))
      kept.u.px[i] = kept.v.px[i] = 0;
  return kept;
}

}  // namespace faba
