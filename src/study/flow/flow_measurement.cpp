#include "study/flow/flow_measurement.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "study/flow/flow_check.h"
#include "vision/files/picture.h"
#include "vision/flow/flow_file.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

constexpr std::uint64_t kCheckedPairs = 8;  // the flow of every eighth pair is compared with its frames

struct FlowSums {
  double u = 0, v = 0, speed = 0, largest = 0;
  std::uint64_t n = 0;

  void add(const Flow& f) {
    for (std::size_t i = 0; i < f.u.px.size(); ++i) {
      const double a = double(f.u.px[i]), b = double(f.v.px[i]), s = std::hypot(a, b);
      u += a;
      v += b;
      speed += s;
      largest = std::max(largest, s);
    }
    n += f.u.px.size();
  }
};

FlowError error_of(const Flow& flow, const std::filesystem::path& file) {
  const Flow truth = read_flo(file);
  if (truth.width() != flow.width() || truth.height() != flow.height())
    throw Error(Errc::input, file.string(),
                fmt::format("is a flow of {} x {} px; it must be {} x {} px, the size of the pictures",
                            truth.width(), truth.height(), flow.width(), flow.height()));
  double endpoint = 0, angle = 0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < flow.u.px.size(); ++i) {
    const double u = double(flow.u.px[i]), v = double(flow.v.px[i]);
    const double a = double(truth.u.px[i]), b = double(truth.v.px[i]);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    endpoint += std::hypot(u - a, v - b);
    const double c = (u * a + v * b + 1) / std::sqrt((u * u + v * v + 1) * (a * a + b * b + 1));
    angle += std::acos(std::clamp(c, -1.0, 1.0));
    ++known;
  }
  if (known == 0) throw Error(Errc::input, file.string(), "the flow is unknown in all pixels");
  const double n = double(known);
  return {endpoint / n, angle / n * 180 / 3.14159265358979323846, n / double(flow.u.px.size())};
}

void require_same_format(const Picture& first, const std::string& a, const Picture& second,
                         const std::string& b) {
  if (first.grey.width != second.grey.width || first.grey.height != second.grey.height)
    throw Error(Errc::input, b,
                fmt::format("is {} x {} px, but {} is {} x {} px; both pictures must have the same size",
                            second.grey.width, second.grey.height, a, first.grey.width, first.grey.height));
  if (first.bits != second.bits)
    throw Error(Errc::input, b,
                fmt::format("has {} bits per pixel, but {} has {}; both pictures must have the same depth",
                            second.bits, a, first.bits));
}

}  // namespace

PairFlow measure_flow(const std::filesystem::path& a, const std::filesystem::path& b,
                      const FlowRegistry::PartType& part, const std::filesystem::path& truth, Pool& pool) {
  Picture first = read_picture(a), second = read_picture(b);
  require_same_format(first, a.string(), second, b.string());
  const GreyScale greys(first.bits, first.grey);
  greys.apply(first.grey);
  greys.apply(second.grey);

  const auto method = part.make({&pool});
  PairFlow r;
  method->between(first.grey, second.grey, r.flow);
  FlowSums sums;
  sums.add(r.flow);
  const double n = double(sums.n);
  r.scale = scale_of_file(a);
  r.method = part.resolved.dump();
  r.effort = method->effort();
  r.mean_px = {sums.u / n, sums.v / n};
  r.mean_speed_px = sums.speed / n;
  r.largest_px = sums.largest;
  if (!truth.empty()) r.error = error_of(r.flow, truth);
  if (!greys.words().empty()) r.notes.push_back(greys.words());
  if (r.effort && !r.effort->converged)
    r.warnings.push_back({"iteration", "the iteration has not converged: the flow is biased towards zero",
                          fmt::format("{} iterations", r.effort->iterations),
                          "increase --iterations, or use --solver multigrid"});
  FlowCheck check;
  check.add(first.grey, second.grey, r.flow);
  r.unexplained = check.unexplained();
  std::ranges::move(check.warnings(r.mean_speed_px), std::back_inserter(r.warnings));
  return r;
}

VideoFlow measure_flow(FlowSource& source, const std::function<void(const FlowPair&)>& take) {
  VideoFlow r;
  FlowPair pair;
  FlowSums sums;
  double t0 = 0;
  FlowCheck check;
  std::shared_ptr<const GrayF> before;
  while (source.next(pair)) {
    if (r.pairs++ == 0) t0 = pair.t0_s;
    sums.add(pair.flow);
    if (r.pairs % kCheckedPairs == 0 && before) check.add(*before, *pair.image, pair.flow, source.shrink());
    if (r.pairs % kCheckedPairs == kCheckedPairs - 1) before = pair.image;
    take(pair);
  }
  r.scale = source.scale();
  r.width = source.width();
  r.height = source.height();
  r.method = source.method();
  r.seconds = pair.t1_s - t0;
  r.timed = source.fps() > 0;
  r.mean_speed_px = sums.speed / double(sums.n);
  r.unexplained = check.unexplained();
  r.warnings = check.warnings(r.mean_speed_px);
  r.notes = source.notes();
  return r;
}

}  // namespace faba
