// The unavoidable work of measurements, for bench/jobs.py: computes the published optical flow of pairs of
// frames in memory by several threads, each for its own pairs. Checks the flow and prints the wall time in s.
//
//     bench_jobs WIDTH HEIGHT PAIRS THREADS
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "core/threads/parallel.h"
#include "study/data/flow_choice.h"
#include "vision/flow/flow.h"

using namespace faba;

namespace {

GrayF waves(int width, int height, double dx) {
  GrayF f(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c)
      f.at(c, r) = float(128 + 60 * std::sin(0.2 * (c - dx)) + 40 * std::sin(0.15 * r));
  return f;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const int width = std::atoi(argv[1]), height = std::atoi(argv[2]), pairs = std::atoi(argv[3]),
            threads = std::atoi(argv[4]);
  const GrayF a = waves(width, height, 0), b = waves(width, height, 0.2);
  const FlowRegistry::PartType method = flow_part(published_flow());
  Pool one_thread(1);
  std::vector<std::thread> running;
  std::vector<Flow> flows{std::size_t(threads)};
  const auto begin = std::chrono::steady_clock::now();
  for (int t = 0; t < threads; ++t)
    running.emplace_back([&, t] {
      const auto flow = method.make({&one_thread});
      for (int k = t; k < pairs; k += threads) flow->between(a, b, flows[std::size_t(t)]);
    });
  for (std::thread& t : running) t.join();
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const Flow& flow : flows) {
    double sum = 0;
    for (const float u : flow.u.px) sum += double(u);
    // The waves move by 0.2 px to the right; 100 sweeps from zero do not reach all of it.
    if (const double mean = sum / double(flow.u.px.size()); !(mean > 0.05 && mean < 0.21)) {
      fmt::print(stderr, "bench_jobs: the mean flow is {:.3f} px\n", mean);
      return 1;
    }
  }
  fmt::print("{:.4f}\n", s);
  return 0;
}
