#include <fmt/format.h>

#include <cmath>

#include "core/kernels/philox_row.h"
#include "core/random/draw_blocks.h"
#include "core/schema.h"
#include "core/vectorised.h"
#include "sim/agents/iterations.h"

namespace faba {
namespace {

/// The Adapted model of the thesis (theory A5; its 3.3.3.3). In pixels per iteration,
///   v = s u + k,   u = b / |b|,   b = response B / unit + (0, earth)
/// with an innate speed s drawn once per cell from {0, ..., n}, n = round(max_speed), and k uniform on the
/// integers
/// {-a, ..., a} per axis, drawn again every `hold` iterations. The field determines the direction only.
/// Limitations: by default the noise is as large as the speed; the drift n/2 does not depend on the field
/// strength; the standard deviation of innate speeds, 0.64 of their mean for n = 9, spreads a swarm by 0.64
/// of its travelled distance (0.58 with continuous_speed).
class Adapted final : public AgentModel {
 public:
  struct Params {
    double max_speed = 9;
    std::optional<double> noise_amplitude;
    double earth = 1;
    int hold = 2;
    bool continuous_speed = false;
  };
  static Schema<Params> schema();
  Adapted(const Params& p, const ModelContext& c);

  std::vector<ColumnSpec> columns() const override;
  void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const override;
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
  const float *bx, *by, *response, *speed;
  float *vx, *vy;
};

FABA_VECTORISED void redraw(const Block& b, const PhiloxRow& row, std::size_t n, std::uint32_t noise,
                            float per_tesla, float earth) {
  const float* __restrict bx = b.bx, * __restrict by = b.by, * __restrict response = b.response, * __restrict speed = b.speed;
  float* __restrict vx = b.vx, * __restrict vy = b.vy;
  const std::uint32_t count = 2 * noise + 1;
  for (std::size_t i = 0; i < n; ++i) {
    // Cells that do not respond to the field do not respond to the Earth's field either.
    const float r = response[i], m = r * per_tesla;
    const float ux = m * bx[i], uy = m * by[i] + earth * r * r;
    const float length = std::sqrt(ux * ux + uy * uy);
    const float s = length > 0.0f ? speed[i] / length : 0.0f;
    vx[i] = float(std::int32_t(below(row.w0[i], count)) - std::int32_t(noise)) + s * ux;
    vy[i] = float(std::int32_t(below(row.w1[i], count)) - std::int32_t(noise)) + s * uy;
  }
}

Schema<Adapted::Params> Adapted::schema() {
  return Schema<Params>("adapted",
                        "Adapted model of the thesis: innate speeds along the field, plus 'inertia' noise")
      .add("max_speed", &Params::max_speed,
           {.min = 0,
            .max = 1000,
            .doc = "Maximum innate speed in px per iteration, rounded to an integer",
            .source = "thesis: 8.9937 fitted (Fig. 4.16)",
            .role = Role::speed,
            .title = "Maximum innate speed"})
      .add("noise_amplitude", &Params::noise_amplitude,
           {.min = 0,
            .max = 1000,
            .doc = "Amplitude of the noise in px per iteration; default: max_speed, as published",
            .source = "thesis 3.3.3.3; 'small inertia' would be 0.2 max_speed (A5)"})
      .add("earth", &Params::earth,
           {.min = -100,
            .max = 100,
            .doc = "Earth's field in field units, added along y to the commanded drift",
            .source = "thesis: 1 unit"})
      .add("hold", &Params::hold,
           {.min = 1,
            .max = 100,
            .doc = "Iterations for which a drawn velocity is kept",
            .source = "thesis 3.3.3 (A3)",
            .title = "Iterations per drawn velocity"})
      .add("continuous_speed", &Params::continuous_speed,
           {.doc = "Innate speeds are real numbers in [0, max_speed] instead of integers"})
      .note([](const Params& p) -> std::string {
        if (p.continuous_speed ? p.max_speed > 0 : std::lround(p.max_speed) > 0) return {};
        return fmt::format(
            "max_speed is {:g}{}: the innate speed of every cell is 0, and the field moves no cell; increase "
            "max_speed",
            p.max_speed, p.continuous_speed ? "" : ", rounded to 0");
      })
      .validity(
          "No turning time; the drift does not depend on the field strength; a fraction 1/(max_speed + 1) "
          "of the cells has speed zero.");
}

Adapted::Adapted(const Params& p, const ModelContext& c) : p_(p), scale_(c.scale), clock_(c, p.hold) {}

std::vector<ColumnSpec> Adapted::columns() const {
  auto columns = Iterations::columns();
  columns.push_back({"speed", "px/iteration", "innate speed"});
  return columns;
}

void Adapted::start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const {
  const auto n = std::uint32_t(std::lround(p_.max_speed));
  auto speed = s.agents["speed"];
  for (std::size_t i = begin; i < end; ++i) {
    const auto w = draw(seed, kBirthDraws, std::uint32_t(i), 0)[0];
    speed[i] = p_.continuous_speed ? float(p_.max_speed) * uniform(w) : float(below(w, n + 1));
  }
}

// Without the Earth's field any field determines the direction. With it, a weak field B changes the direction
// by B / earth.
WeakestField Adapted::weakest_field(double) const {
  constexpr double kDirection = 0.01;  // rad
  return {kDirection * std::fabs(p_.earth) * scale_.field_unit,
          "a weaker field changes the direction of the Earth's field by less than 0.01 rad"};
}

// The mean innate speed is half the largest one.
SwarmMotion Adapted::motion() const {
  const double pixels = scale_.m_per_px / scale_.iteration;
  const double n = double(std::lround(p_.noise_amplitude.value_or(p_.max_speed)));
  return {.response = SwarmMotion::Response::constant,
          .speed = pixels * p_.max_speed / 2,
          .spread = pixels * scale_.m_per_px * p_.hold * n * (n + 1) / 6};
}

void Adapted::step(State& s, const StepContext& c) const {
  auto& a = s.agents;
  const auto noise = std::uint32_t(std::lround(p_.noise_amplitude.value_or(p_.max_speed)));
  const auto per_tesla = float(1 / scale_.field_unit), earth = float(p_.earth);
  if (clock_.redraws(s.step)) {
    const float *response = &a["response"][c.begin], *speed = &a["speed"][c.begin];
    float *vx = &a["vx"][c.begin], *vy = &a["vy"][c.begin];
    for_rows(c.seed, Stream::motion, c.begin, c.end - c.begin, clock_.index(s.step),
             [&](std::size_t i, std::size_t n, const PhiloxRow& row) {
               redraw({&c.bx[i], &c.by[i], response + i, speed + i, vx + i, vy + i}, row, n, noise, per_tesla,
                      earth);
             });
  }
  clock_.move(s, c, float(scale_.m_per_px) * c.speed_factor);
}

}  // namespace

void add_adapted(ModelRegistry& r) { r.add<Adapted>(); }

}  // namespace faba
