#include "vision/flow/horn_schunck.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "vision/flow/kernels/flow_sweep.h"
#include "vision/flow/warp.h"

namespace faba {
namespace {

constexpr int kSmallest = 32;    // px, minimum of the smaller side of the coarsest pyramid level
constexpr int kCheckEvery = 10;  // Jacobi sweeps between two convergence checks

template <class T>
void smooth(Plane<T>& p, double sd) {
  if (sd <= 0) return;
  cv::Mat m(p.height(), p.width(), cv::DataType<T>::type, p.row(0),
            std::size_t(p.row(1) - p.row(0)) * sizeof(T));
  cv::GaussianBlur(m, m, {0, 0}, sd, sd, cv::BORDER_REPLICATE);
}

template <class T>
void downscale_by_2(const Plane<T>& fine, Plane<T>& out) {
  out.resize((fine.width() + 1) / 2, (fine.height() + 1) / 2);
  for (int r = 0; r < out.height(); ++r) {
    const T *a = fine.row(2 * r), *b = fine.row(std::min(2 * r + 1, fine.height() - 1));
    for (int c = 0; c < out.width(); ++c) {
      const int left = 2 * c, right = std::min(left + 1, fine.width() - 1);
      out.row(r)[c] = ((a[left] + a[right]) + (b[left] + b[right])) * T(0.25);
    }
  }
}

// Pixels warped from outside the picture have no data term: their flow follows from the neighbours.
template <class T>
void clear_unknown_derivatives(FlowDerivatives<T>& d) {
  for (int r = 0; r < d.it.height(); ++r)
    for (int c = 0; c < d.it.width(); ++c)
      if (!std::isfinite(d.it.row(r)[c])) d.ix.row(r)[c] = d.iy.row(r)[c] = d.it.row(r)[c] = 0;
}

}  // namespace

Schema<HornSchunckParams> HornSchunckParams::schema() {
  using P = HornSchunckParams;
  P published;
  published.solver = FlowSolver::jacobi;
  published.tolerance = 0;
  return Schema<P>("horn_schunck", "Optical flow of Horn and Schunck: constant brightness and smooth flow")
      .add("alpha2", &P::alpha2,
           {.min = 1e-6,
            .max = 1e12,
            .doc = "Weight of smoothness, grey levels squared on a scale of 0 to 255",
            .source = "assumed (A22): the thesis does not give it"})
      .add("solver", &P::solver,
           {.doc = "multigrid: solves to convergence; jacobi: the published iteration, starting at zero",
            .choices = {"multigrid", "jacobi"}})
      .add("iterations", &P::iterations,
           {.min = 1,
            .max = 1e6,
            .doc = "Maximum number of cycles (multigrid) or sweeps (jacobi)",
            .source = "A22"})
      .add("tolerance", &P::tolerance,
           {.unit = "px",
            .min = 0,
            .max = 1e3,
            .doc = "Convergence: no component changes by more in a cycle, or in every tenth sweep; 0: always "
                   "all iterations",
            .source = "A22"})
      .add("smooth", &P::smooth,
           {.unit = "px",
            .min = 0,
            .max = 50,
            .doc = "Standard deviation of the Gaussian smoothing of the frames; 0: none"})
      .add("pyramid", &P::pyramid,
           {.doc = "Coarse-to-fine pyramid with warping, for displacements above 2 px per frame"})
      .add("warps", &P::warps, {.min = 1, .max = 100, .doc = "Warps per pyramid level"})
      .preset("published", published,
              "100 sweeps from zero, as in common implementations at the time of the thesis (A22): an "
              "activity measure that stays local to moving objects")
      .validity(
          "Without pyramid, displacements of up to about twice the size of the moving object are measured "
          "correctly (for a spot of 1 px standard deviation: 2 px per frame); for larger ones the flow is an "
          "activity index, not a velocity, and its direction may be reversed (A22). With pyramid, larger "
          "displacements are measured for objects that remain visible in the downscaled picture: not for "
          "single cells that move by more than their size per frame. In uniform areas the flow is "
          "extrapolated from the neighbours: 100 jacobi sweeps reach about 10 px, multigrid any distance.");
}

template <class T>
void HornSchunck<T>::solve(Plane<T>& a, Plane<T>& b, bool warped) {
  differentiate(a, b, derivatives_, pool_);
  if (warped) clear_unknown_derivatives(derivatives_);
  system_.lambda = T(p_.alpha2);
  system_.set_up(derivatives_, warped ? &w_ : nullptr, p_.solver == FlowSolver::multigrid, pool_);
  spare_.resize(a.width(), a.height());
  const auto within = [&](T change) { return p_.tolerance > 0 && double(change) < p_.tolerance; };
  converged_ = false;
  int n = 0;
  if (p_.solver == FlowSolver::multigrid) {
    multigrid_.set_up(system_, pool_);
    if (!warped) multigrid_.guess(system_, w_, spare_, pool_);
    for (; n < p_.iterations && !converged_; ++n)
      converged_ = within(multigrid_.cycle(system_, w_, spare_, pool_));
  } else if (p_.tolerance > 0) {
    for (; n < p_.iterations && !converged_; n += kCheckEvery)
      converged_ = within(sweep(system_, w_, spare_, std::min(kCheckEvery, p_.iterations - n), true, pool_));
    n = std::min(n, p_.iterations);
  } else {
    sweep(system_, w_, spare_, n = p_.iterations, false, pool_);
  }
  done_ += n;
}

template <class T>
void HornSchunck<T>::coarse_to_fine() {
  for (std::size_t i = 1; std::min(levels_.back().a.width(), levels_.back().a.height()) >= 2 * kSmallest;
       ++i) {
    levels_.emplace_back();
    downscale_by_2(levels_[i - 1].a, levels_[i].a);
    downscale_by_2(levels_[i - 1].b, levels_[i].b);
  }
  for (std::size_t i = levels_.size(); i-- > 0;) {
    Level& level = levels_[i];
    FlowPlanes<T> next_w;
    next_w.resize(level.a.width(), level.a.height());
    if (i + 1 < levels_.size()) {
      // Displacements in px double with the resolution: add the prolonged flow twice.
      prolong_and_add(w_, next_w, pool_);
      prolong_and_add(w_, next_w, pool_);
    }
    w_ = std::move(next_w);
    done_ = 0;
    for (int k = 0; k < p_.warps; ++k) {
      warp(level.b, w_, warped_, pool_);
      solve(level.a, warped_, true);
    }
  }
}

template <class T>
const FlowPlanes<T>& HornSchunck<T>::between(Plane<T>& a, Plane<T>& b) {
  done_ = 0;
  const bool copied = p_.pyramid || p_.smooth > 0;
  if (copied) {
    levels_.resize(1);
    levels_[0] = {a, b};
    smooth(levels_[0].a, p_.smooth);
    smooth(levels_[0].b, p_.smooth);
  }
  if (p_.pyramid) {
    coarse_to_fine();
    return w_;
  }
  w_.resize(a.width(), a.height());
  w_.clear();
  solve(copied ? levels_[0].a : a, copied ? levels_[0].b : b, false);
  return w_;
}

template class HornSchunck<float>;
template class HornSchunck<double>;

namespace {

class HornSchunckFlow final : public FlowMethod {
 public:
  using Params = HornSchunckParams;
  static Schema<Params> schema() { return Params::schema(); }
  HornSchunckFlow(const Params& p, const FlowContext& c) : solver_(p, *c.pool) {}

  void between(const GrayF& a, const GrayF& b, Flow& out) override {
    to_plane(a, a_);
    to_plane(b, b_);
    const FlowPlanes<float>& w = solver_.between(a_, b_);
    to_image(w.u, out.u);
    to_image(w.v, out.v);
  }
  std::optional<FlowEffort> effort() const override {
    return FlowEffort{solver_.iterations(), solver_.converged()};
  }

 private:
  static void to_plane(const GrayF& from, Plane<float>& to) {
    to.resize(from.width, from.height);
    for (int r = 0; r < from.height; ++r)
      std::copy_n(&from.px[std::size_t(r) * std::size_t(from.width)], from.width, to.row(r));
  }
  static void to_image(const Plane<float>& from, GrayF& to) {
    if (to.width != from.width() || to.height != from.height()) to = GrayF(from.width(), from.height());
    for (int r = 0; r < to.height; ++r)
      std::copy_n(from.row(r), to.width, &to.px[std::size_t(r) * std::size_t(to.width)]);
  }
  HornSchunck<float> solver_;
  Plane<float> a_, b_;
};

}  // namespace

void add_horn_schunck(FlowRegistry& r) { r.add<HornSchunckFlow>(); }

}  // namespace faba
