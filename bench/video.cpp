// Measures the time of the published iteration of optical flow, of the converged solution and of the
// histogram distance with one and two threads, compared with a simple loop, methods of OpenCV and the memory
// bandwidth. Checks all results. Prints one JSON object per line for bench/video.py.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <random>

#include <nlohmann/json.hpp>

#include "app/scenario/parts.h"
#include "machine.h"
#include "timing.h"
#include "vision/flow/horn_schunck.h"
#include "vision/flow/kernels/flow_sweep.h"
#include "vision/image/kernels/histogram_distance.h"

using namespace faba;
using namespace faba::bench;

namespace {

constexpr int kWidth = 640, kHeight = 480, kSweeps = 100;
constexpr int kPairs = 10;                // frame pairs in one timed call
constexpr double kDx = 0.5, kDy = -0.25;  // px, displacement of the texture

// Waves of several lengths and directions, moved by (dx, dy).
double texture(double x, double y) {
  return 128 + 40 * std::sin(0.13 * x + 0.3 * std::sin(0.05 * y)) + 30 * std::sin(0.17 * y) +
         20 * std::sin(0.2 * (x + y));
}
GrayF frame(double dx, double dy) {
  GrayF f(kWidth, kHeight);
  for (int r = 0; r < kHeight; ++r)
    for (int c = 0; c < kWidth; ++c) f.at(c, r) = float(texture(c - dx, r - dy));
  return f;
}
Plane<float> plane(const GrayF& f) {
  Plane<float> p(f.width, f.height);
  for (int r = 0; r < f.height; ++r) std::copy_n(&f.px[std::size_t(r) * kWidth], kWidth, p.row(r));
  return p;
}

/// Mean endpoint error over all pixels and over the pixels far from the border, px. At the border, the
/// published differences repeat pixels and give half of the gradient.
struct EndpointError {
  double all = 0, inside = 0;
};
EndpointError endpoint_error(const GrayF& u, const GrayF& v) {
  constexpr int kBorder = 30;
  EndpointError e;
  for (int r = 0; r < kHeight; ++r)
    for (int c = 0; c < kWidth; ++c) {
      const double d = std::hypot(double(u.at(c, r)) - kDx, double(v.at(c, r)) - kDy);
      e.all += d / (kWidth * kHeight);
      if (r >= kBorder && r < kHeight - kBorder && c >= kBorder && c < kWidth - kBorder)
        e.inside += d / ((kWidth - 2 * kBorder) * (kHeight - 2 * kBorder));
    }
  return e;
}

/// Dependent additions, which take one clock cycle each: measures the clock frequency.
constexpr int kAdditions = 10000000;
void add_in_a_row() {
  unsigned long x = 0;
  for (int i = 0; i < kAdditions; ++i) asm volatile("add $1, %0" : "+r"(x));
}

/// The published iteration as a simple loop over the pixels, with clamped borders and two copies of the flow.
class PlainLoop {
 public:
  PlainLoop(const GrayF& a, const GrayF& b) : a_(a), b_(b), u(kWidth, kHeight), v(kWidth, kHeight) {}
  void run() {
    ix_ = iy_ = it_ = GrayF(kWidth, kHeight);
    for (int r = 0; r < kHeight; ++r)
      for (int c = 0; c < kWidth; ++c) {
        const int d = std::min(r + 1, kHeight - 1), e = std::min(c + 1, kWidth - 1);
        ix_.at(c, r) = (a_.at(e, r) - a_.at(c, r) + a_.at(e, d) - a_.at(c, d) + b_.at(e, r) - b_.at(c, r) +
                        b_.at(e, d) - b_.at(c, d)) /
                       4;
        iy_.at(c, r) = (a_.at(c, d) - a_.at(c, r) + a_.at(e, d) - a_.at(e, r) + b_.at(c, d) - b_.at(c, r) +
                        b_.at(e, d) - b_.at(e, r)) /
                       4;
        it_.at(c, r) = (b_.at(c, r) - a_.at(c, r) + b_.at(e, r) - a_.at(e, r) + b_.at(c, d) - a_.at(c, d) +
                        b_.at(e, d) - a_.at(e, d)) /
                       4;
      }
    u = v = GrayF(kWidth, kHeight);
    GrayF u0, v0;
    for (int k = 0; k < kSweeps; ++k) {
      u0 = u;
      v0 = v;
      for (int r = 0; r < kHeight; ++r)
        for (int c = 0; c < kWidth; ++c) {
          const float um = mean(u0, c, r), vm = mean(v0, c, r), gx = ix_.at(c, r), gy = iy_.at(c, r);
          const float s = (gx * um + gy * vm + it_.at(c, r)) / (100 + gx * gx + gy * gy);
          u.at(c, r) = um - gx * s;
          v.at(c, r) = vm - gy * s;
        }
    }
  }

 private:
  static float mean(const GrayF& p, int c, int r) {
    const int l = std::max(c - 1, 0), e = std::min(c + 1, kWidth - 1), t = std::max(r - 1, 0),
              d = std::min(r + 1, kHeight - 1);
    return (p.at(l, r) + p.at(e, r) + p.at(c, t) + p.at(c, d)) / 6 +
           (p.at(l, t) + p.at(e, t) + p.at(l, d) + p.at(e, d)) / 12;
  }
  const GrayF &a_, &b_;
  GrayF ix_, iy_, it_;

 public:
  GrayF u, v;
};

GrayF grey(const Plane<float>& p) {
  GrayF g(p.width(), p.height());
  for (int r = 0; r < g.height; ++r) std::copy_n(p.row(r), g.width, &g.px[std::size_t(r) * kWidth]);
  return g;
}

HornSchunckParams params(FlowSolver solver, int iterations, double tolerance) {
  HornSchunckParams p;
  p.solver = solver;
  p.iterations = iterations;
  p.tolerance = tolerance;
  return p;
}

struct Row {
  nlohmann::ordered_json about;
  Timed timed;
  std::function<EndpointError()> error;  ///< after the work
};

std::vector<Row> flow_rows(const GrayF& a, const GrayF& b) {
  std::vector<Row> rows;
  const auto pa = std::make_shared<Plane<float>>(plane(a)), pb = std::make_shared<Plane<float>>(plane(b));
  for (const unsigned threads : {1u, 2u}) {
    const auto pool = std::make_shared<Pool>(threads);
    for (const auto& [name, p] : {std::pair{"jacobi", params(FlowSolver::jacobi, kSweeps, 0)},
                                  std::pair{"converged", params(FlowSolver::multigrid, 100, 0.003)}}) {
      const auto solver = std::make_shared<HornSchunck<float>>(p, *pool);
      const auto flow = std::make_shared<std::pair<GrayF, GrayF>>();
      Row row;
      row.about = {{"what", name}, {"threads", threads}};
      row.timed.work = [=] { solver->between(*pa, *pb); };
      row.error = [=] {
        const auto& w = solver->between(*pa, *pb);
        return endpoint_error(grey(w.u), grey(w.v));
      };
      row.timed.prepare = [pool] {};
      rows.push_back(std::move(row));
    }
  }
  const auto loop = std::make_shared<PlainLoop>(a, b);
  rows.push_back({{{"what", "plain loop"}, {"threads", 1}}, {[] {}, [=] { loop->run(); }}, [=] {
                    return endpoint_error(loop->u, loop->v);
                  }});
  const auto pool = std::make_shared<Pool>(1u);
  for (const char* name : {"dis", "farneback"}) {
    Document d;
    d.root = {{"type", name}};
    const std::shared_ptr<FlowMethod> method = builtin_parts().flow.resolve(Node(d)).make({pool.get()});
    const auto flow = std::make_shared<Flow>();
    rows.push_back({{{"what", name}, {"threads", 1}},
                    {[pool] {}, [=, &a, &b] { method->between(a, b, *flow); }},
                    [=] { return endpoint_error(flow->u, flow->v); }});
  }
  return rows;
}

// Histograms with 640 and 480 bins, the sums over rows and columns of a frame.
struct Bins {
  std::vector<double> p, q;
};
Bins bins(std::size_t n, unsigned seed) {
  std::mt19937 g(seed);
  Bins b;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = double(i) / double(n);
    b.p.push_back(50 * std::exp(-30 * (x - 0.4) * (x - 0.4)) + double(g() % 100) / 50);
    b.q.push_back(50 * std::exp(-30 * (x - 0.5) * (x - 0.5)) + double(g() % 100) / 50);
  }
  return b;
}
double by_definition(const Bins& b, double m, double threshold) {
  const int n = int(b.p.size()), reach = int(std::ceil(threshold));
  std::vector<double> d(b.p.size());
  const auto a = [&](int k) { return std::max(0.0, 1 - std::abs(k) / threshold); };
  const auto each = [&](int i, auto&& take) {
    for (int j = std::max(0, i - reach); j <= std::min(n - 1, i + reach); ++j) take(std::size_t(j), a(i - j));
  };
  for (int i = 0; i < n; ++i) {
    double z = 0;
    each(i, [&](std::size_t j, double w) { z += (b.p[j] + b.q[j]) * w; });
    d[std::size_t(i)] = (b.p[std::size_t(i)] - b.q[std::size_t(i)]) / std::pow(z, m);
  }
  double sum = 0;
  for (int i = 0; i < n; ++i) each(i, [&](std::size_t j, double w) { sum += d[std::size_t(i)] * d[j] * w; });
  return std::sqrt(sum);
}

// Memory traffic of one sweep over all pixels without a cache: nine planes of 32 bits (triad: three); and the
// clock of the processor.
void add_machine_rows(std::vector<Row>& rows) {
  const std::size_t pixels = std::size_t(kWidth) * kHeight;
  for (const unsigned threads : {1u, 2u}) {
    const auto pool = std::make_shared<Pool>(threads);
    const auto machine = std::make_shared<Machine>(pixels, *pool);
    rows.push_back({{{"what", "memory"}, {"threads", threads}},
                    {[pool] {}, [=] { machine->run("triad", 3 * kSweeps); }},
                    [] { return EndpointError{}; }});
  }
  rows.push_back(
      {{{"what", "clock"}, {"threads", 1}}, {[] {}, add_in_a_row}, [] { return EndpointError{}; }});
  rows.back().timed.units = kAdditions / 1e6;
}

// The histogram distance. Returns whether it agrees with its definition. `wide` and `high` must exist while
// the rows are timed.
bool add_distance_rows(std::vector<Row>& rows, const Bins& wide, const Bins& high) {
  bool right = true;
  for (const double threshold : {3.0, 20.0}) {
    const auto distance =
        std::make_shared<HistogramDistance>(BinSimilarity::truncated_linear(threshold), 0.9);
    for (const Bins* one : {&wide, &high})
      right =
          right && std::fabs((*distance)(one->p, one->q) / by_definition(*one, 0.9, threshold) - 1) < 1e-12;
    Row row;
    row.about = {{"what", "distance"}, {"threshold", threshold}, {"threads", 1}};
    row.timed.prepare = [] {};
    row.timed.units = 1000;
    row.timed.work = [=, &wide, &high] {
      volatile double sum = 0;
      for (int i = 0; i < 1000; ++i) sum = sum + (*distance)(wide.p, wide.q) + (*distance)(high.p, high.q);
    };
    row.error = [] { return EndpointError{}; };
    rows.push_back(std::move(row));
  }
  return right;
}

// Times all rows, and prints them with their errors.
void time_rows(std::vector<Row>& rows) {
  std::vector<Timed> all;
  for (Row& r : rows) {
    // The plain loop takes as long as ten frame pairs of the other methods.
    if (const auto what = r.about["what"]; what != "distance" && what != "clock" && what != "plain loop") {
      r.timed.units *= kPairs;
      r.timed.work = [one = std::move(r.timed.work)] {
        for (int i = 0; i < kPairs; ++i) one();
      };
    }
    all.push_back(std::move(r.timed));
  }
  time_in_turns(all, 9, 20);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Spread s = spread(all[i].ns);
    rows[i].about["ms"] = s.median / 1e6;
    rows[i].about["low_ms"] = s.low / 1e6;
    rows[i].about["high_ms"] = s.high / 1e6;
    const EndpointError e = rows[i].error();
    rows[i].about["error_px"] = e.all;
    rows[i].about["inside_px"] = e.inside;
    fmt::print("{}\n", rows[i].about.dump());
  }
}

}  // namespace

int main() {
  const GrayF a = frame(0, 0), b = frame(kDx, kDy);
  std::vector<Row> rows = flow_rows(a, b);
  add_machine_rows(rows);
  const Bins wide = bins(640, 1), high = bins(480, 2);
  bool right = add_distance_rows(rows, wide, high);
  time_rows(rows);
  // The plain loop and the published iteration must agree within 32-bit rounding errors.
  std::map<std::string, double> error;
  for (const Row& r : rows) error[r.about["what"].get<std::string>()] = r.about["error_px"].get<double>();
  right = right && std::fabs(error["jacobi"] - error["plain loop"]) < 1e-4;
  fmt::print(
      "{}\n",
      nlohmann::ordered_json{{"what", "check"}, {"right", right}, {"vector_unit", vector_unit()}}.dump());
  return right ? 0 : 1;
}
