#include "vision/image/coding_traces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/statistics.h"
#include "vision/image/kernels/arithmetic.h"

namespace faba {
namespace {

constexpr int kBlock = 8;  // px
constexpr std::size_t kMostPairs = 12;
constexpr int kSmallestFrame = 8 * kBlock;  // px, side of a frame
constexpr double kMostSteps = 1000;         // where changes are the same in all pixels of each block
constexpr double kClip = 4;                 // mean absolute changes: moving objects are not coding

// Of the change between two frames: absolute steps from one column (row) to the next, and its blocks.
struct Steps {
  std::vector<double> across, down;
  double blocks = 0, equal = 0;

  explicit Steps(const CompactImage& frame)
      : across(std::size_t(frame.width() - 1)), down(std::size_t(frame.height() - 1)) {}
  void add(const Steps& other) {
    for (std::size_t i = 0; i < across.size(); ++i) across[i] += other.across[i];
    for (std::size_t i = 0; i < down.size(); ++i) down[i] += other.down[i];
    blocks += other.blocks;
    equal += other.equal;
  }
};

double mean_absolute(const GrayF& change) {
  double sum = 0;
  for (const float v : change.px) sum += std::fabs(double(v));
  return sum / double(change.px.size());
}

void add_steps(const GrayF& change, Steps& steps) {
  const auto limit = float(kClip * mean_absolute(change));
  const auto at = [&](int x, int y) { return std::clamp(change.at(x, y), -limit, limit); };
  for (int y = 0; y + 1 < change.height; ++y)
    for (int x = 0; x + 1 < change.width; ++x) {
      const float here = at(x, y);
      steps.across[std::size_t(x)] += double(std::fabs(at(x + 1, y) - here));
      steps.down[std::size_t(y)] += double(std::fabs(at(x, y + 1) - here));
    }
}

// The phase with the largest steps against the mean of the others, paired by period of the grid.
CodingTraces traces_along(const std::vector<double>& steps) {
  const std::size_t periods = steps.size() / kBlock;
  std::array<double, kBlock> sums{};
  for (std::size_t i = 0; i < periods * kBlock; ++i) sums[i % kBlock] += steps[i];
  const std::size_t edge = std::size_t(std::max_element(sums.begin(), sums.end()) - sums.begin());
  double sum = 0, squares = 0, level = 0;
  for (std::size_t p = 0; p < periods; ++p) {
    double others = 0;
    for (std::size_t k = 0; k < kBlock; ++k)
      if (k != edge) others += steps[p * kBlock + k] / (kBlock - 1);
    const double excess = steps[p * kBlock + edge] - others;
    sum += excess;
    squares += excess * excess;
    level += others;
  }
  const auto n = double(periods);
  const double variance = (squares - sum * sum / n) / (n - 1);
  CodingTraces t;
  if (sum > 0) t.block_steps = sum / std::max(level, sum / kMostSteps);
  if (variance > 0) t.significance = sum / std::sqrt(n * variance);
  return t;
}

template <class Take>  // called with the range of each complete block
void for_blocks(const GrayF& g, Take&& take) {
  for (int y = 0; y + kBlock <= g.height; y += kBlock)
    for (int x = 0; x + kBlock <= g.width; x += kBlock) take(x, y);
}

bool changed(const GrayF& change, int left, int top) {
  for (int y = top; y < top + kBlock; ++y)
    for (int x = left; x < left + kBlock; ++x)
      if (change.at(x, y) != 0) return true;
  return false;
}

}  // namespace

CodingTraces coding_traces(const std::vector<CompactImage>& frames, Pool& pool) {
  if (frames.size() < 2 || std::min(frames[0].width(), frames[0].height()) < kSmallestFrame) return {};
  std::vector<Steps> pairs(std::min(frames.size() - 1, kMostPairs), Steps(frames[0]));
  pool.run_uneven(pairs.size(), [&](std::size_t k) {
    GrayF change = frames[k + 1].image();
    subtract(change, frames[k].image());
    add_steps(change, pairs[k]);
    for_blocks(change, [&](int x, int y) {
      pairs[k].blocks += 1;
      pairs[k].equal += changed(change, x, y) ? 0 : 1;
    });
  });
  Steps steps(frames[0]);
  for (const Steps& pair : pairs) steps.add(pair);
  const CodingTraces across = traces_along(steps.across), down = traces_along(steps.down);
  CodingTraces t = across.significance > down.significance ? across : down;
  t.unchanged = steps.equal / steps.blocks;
  return t;
}

float coded_noise(const GrayF& difference, const GrayF& response) {
  constexpr double kQuantile = 0.8, kNormal = 1.2815515655446004;
  constexpr std::size_t kMostBlocks = 4000;  // a sample is sufficient
  struct Corner {
    int left, top;
  };
  std::vector<Corner> blocks;
  for_blocks(difference, [&](int left, int top) {
    if (changed(difference, left, top)) blocks.push_back({left, top});
  });
  std::vector<float> values;
  for (std::size_t i = 0; i < blocks.size(); i += 1 + blocks.size() / kMostBlocks)
    for (int y = blocks[i].top; y < blocks[i].top + kBlock; ++y)
      for (int x = blocks[i].left; x < blocks[i].left + kBlock; ++x)
        values.push_back(std::fabs(response.at(x, y)));
  return values.empty() ? 0 : quantile_low(values, kQuantile) / float(kNormal);
}

}  // namespace faba
