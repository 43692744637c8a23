#include <cmath>

#include "core/kernels/philox_row.h"
#include "core/schema.h"
#include "core/vectorised.h"
#include "sim/agents/iterations.h"

namespace faba {
namespace {

/// The Basic model of the thesis (theory A4, eq. 3.1, with the hold of A3). Per axis, in pixels per
/// iteration,
///   v = k + m,   k uniform on the integers {-n, ..., n},  n = round(max_speed),
/// drawn again every `hold` iterations; m is the drift due to the field, in field units.
/// Var[v] = n(n+1)/3 per axis; long-time diffusion hold n(n+1)/6 px^2 per iteration.
/// Limitations: `max_speed` is the amplitude of the noise, not a swimming speed; the drift m does not depend
/// on it.
class Basic final : public AgentModel {
 public:
  struct Params {
    double max_speed = 8;
    int hold = 2;
  };
  static Schema<Params> schema();
  Basic(const Params& p, const ModelContext& c);

  std::vector<ColumnSpec> columns() const override { return Iterations::columns(); }
  void start(State&, std::size_t, std::size_t, std::uint64_t) const override {
  }  // all cells start with zero velocity
  void step(State& s, const StepContext& c) const override;
  double longest_step(double) const override { return scale_.iteration; }
  WeakestField weakest_field(double time) const override;
  SwarmMotion motion() const override;

 private:
  Params p_;
  Scale scale_;
  Iterations clock_;
};

struct Block {
  const float *bx, *by, *response;
  float *vx, *vy;
};

// Velocities in px per iteration.
FABA_VECTORISED void redraw(const Block& b, const PhiloxRow& row, std::size_t n, std::uint32_t noise,
                            float per_tesla) {
  const float* __restrict bx = b.bx, * __restrict by = b.by, * __restrict response = b.response;
  float* __restrict vx = b.vx, * __restrict vy = b.vy;
  const std::uint32_t count = 2 * noise + 1;
  for (std::size_t i = 0; i < n; ++i) {
    const float m = response[i] * per_tesla;
    vx[i] = float(std::int32_t(below(row.w0[i], count)) - std::int32_t(noise)) + m * bx[i];
    vy[i] = float(std::int32_t(below(row.w1[i], count)) - std::int32_t(noise)) + m * by[i];
  }
}

Schema<Basic::Params> Basic::schema() {
  return Schema<Params>(
             "basic", "Basic model of the thesis: drift due to the field plus uniform integer noise, eq. 3.1")
      .add("max_speed", &Params::max_speed,
           {.min = 0,
            .max = 1000,
            .doc = "Amplitude of the noise in px per iteration, rounded to an integer; not a swimming speed: "
                   "the drift does not depend on it",
            .source = "thesis: 8.1181 fitted (Fig. 4.15)",
            .role = Role::speed,
            .title = "Noise amplitude"})
      .add("hold", &Params::hold,
           {.min = 1,
            .max = 100,
            .doc = "Iterations for which a drawn velocity is kept",
            .source = "thesis 3.3.3 (A3)",
            .title = "Iterations per drawn velocity"})
      .validity(
          "The model is a random walk with drift. It has no heading and no turning time, and its drift does "
          "not depend on max_speed.");
}

Basic::Basic(const Params& p, const ModelContext& c) : p_(p), scale_(c.scale), clock_(c, p.hold) {}

// The drift is one pixel per iteration and field unit.
WeakestField Basic::weakest_field(double time) const {
  return {scale_.field_unit * scale_.iteration / time,
          "a weaker field moves the cells by less than one pixel during the run"};
}

SwarmMotion Basic::motion() const {
  const double pixels = scale_.m_per_px / scale_.iteration, n = double(std::lround(p_.max_speed));
  return {.response = SwarmMotion::Response::proportional,
          .mobility = pixels / scale_.field_unit,
          .spread = pixels * scale_.m_per_px * p_.hold * n * (n + 1) / 6};
}

void Basic::step(State& s, const StepContext& c) const {
  auto& a = s.agents;
  const auto noise = std::uint32_t(std::lround(p_.max_speed));
  const auto per_tesla = float(1 / scale_.field_unit);
  if (clock_.redraws(s.step)) {
    const float* response = &a["response"][c.begin];
    float *vx = &a["vx"][c.begin], *vy = &a["vy"][c.begin];
    for_rows(c.seed, Stream::motion, c.begin, c.end - c.begin, clock_.index(s.step),
             [&](std::size_t i, std::size_t n, const PhiloxRow& row) {
               redraw({&c.bx[i], &c.by[i], response + i, vx + i, vy + i}, row, n, noise, per_tesla);
             });
  }
  clock_.move(s, c, float(scale_.m_per_px) * c.speed_factor);
}

}  // namespace

void add_basic(ModelRegistry& r) { r.add<Basic>(); }

}  // namespace faba
