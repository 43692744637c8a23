#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "core/kernels/philox_row.h"
#include "core/random/draw_blocks.h"
#include "core/schema.h"
#include "core/vectorised.h"
#include "sim/agent_model.h"

namespace faba {
namespace {

/// A self-propelled magnetic dipole in the plane, overdamped (theory B1-B3, SI throughout):
///   d theta = -w_B sin(theta - theta_B) dt + sqrt(2 D_r) dW,   w_B = m B / f_r,
///   dx = v n dt + sqrt(2 D_t) dW,
///   f_r = drag_factor 8 pi eta R^3,  f_t = 6 pi eta R,  D_r = kT / f_r,  D_t = kT / f_t.
/// theta is the direction of the moment times polarity. Integrated by the exact solution of the torque
/// followed by Ornstein-Uhlenbeck noise (D1), which stays within 2 % for any w_B dt; positions by the mean of
/// both headings. Run-reverse cells change the sign of their speed; the moment keeps its direction. A tumble
/// turns the heading. Speeds have a normal distribution truncated to [0, speed_max], moments a lognormal one.
/// Not modelled: helical paths, flagella that limit turning in strong fields, hydrodynamic interactions
/// (small below about 1 % volume fraction), the force (m.grad)B (0.05 % of the thrust at 1 T/m), and depth.
class Dipole final : public AgentModel {
 public:
  struct Params {
    double moment = 1e-15;
    double moment_spread = 0;
    double radius = 0.7e-6;
    double drag_factor = 1;
    double viscosity = 0.89e-3;
    double temperature = 298.15;
    std::optional<double> rotational_diffusion = {};
    std::optional<double> translational_diffusion = {};
    double speed = 186e-6;
    double speed_sd = 45e-6;
    double speed_max = 320e-6;
    double motile = 1;
    double reversal_rate = 0;
    double tumble_rate = 0;
    std::optional<double> tumble_sd = {};
  };
  static Schema<Params> schema();
  Dipole(const Params& p, const ModelContext& c);

  std::vector<ColumnSpec> columns() const override;
  void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const override;
  void step(State& s, const StepContext& c) const override;
  double longest_step(double b_max) const override;
  WeakestField weakest_field(double time) const override;
  SwarmMotion motion() const override {
    return {.speed = p_.speed, .turning = turning_, .diffusion = d_r_, .spread = d_t_};
  }

 private:
  void reorient(State& s, const StepContext& c) const;

  Params p_;
  double turning_;  ///< median m / f_r, rad/(s T)
  double d_r_, d_t_;
};

struct Block {
  const float *bx, *by, *response, *turning, *speed, *x, *y;
  float *ux, *uy, *to_x, *to_y;
};
struct Constants {
  float dt, spread_r /* 2 D_r dt */, sd_t /* sqrt(2 D_t dt) */, half_step /* speed_factor dt / 2 */;
};

// One Philox block feeds the three normals: words 0, 1 turn the heading, words 2, 3 move the cell.
FABA_VECTORISED void swim(const Block& b, const Constants& c, const PhiloxRow& row, std::size_t n) {
  const float *bx = b.bx, *by = b.by, *response = b.response, *turning = b.turning, *speed = b.speed,
              *x = b.x, *y = b.y;
  float *ux = b.ux, *uy = b.uy, *to_x = b.to_x, *to_y = b.to_y;
  const Constants k = c;
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) {
    // A normal number is sqrt(turn_square) turn_cos (Box and Muller); the root is taken once, further below.
    const float turn_square = -2.0f * portable::log(uniform(row.w0[i]));
    const float turn_cos =
        portable::sincos(float(std::int32_t(row.w1[i]) >> 8) * (portable::kPiF * 0x1p-23f)).cos;
    const float move_radius = k.sd_t * std::sqrt(-2.0f * portable::log(uniform(row.w2[i])));
    const auto move_angle =
        portable::sincos(float(std::int32_t(row.w3[i]) >> 8) * (portable::kPiF * 0x1p-23f));

    // Direction h to which the heading u turns: along the field, or against it for south-seeking cells.
    const float b2 = bx[i] * bx[i] + by[i] * by[i];
    const float length = std::sqrt(b2), sign = response[i] < 0.0f ? -1.0f : 1.0f;
    const bool none = !(b2 > 0.0f);
    const float inverse = sign / (none ? 1.0f : length);
    const float hx = none ? 1.0f : bx[i] * inverse, hy = none ? 0.0f : by[i] * inverse;
    const float w = turning[i] * length * (sign * response[i]);

    // Exact torque: with delta the angle from h to u, tan(delta / 2) -> e^(-w dt) tan(delta / 2). Uses the
    // form sin / (1 + cos) or (1 - cos) / sin without cancellation, so that nearly antiparallel cells turn
    // correctly.
    const float cos0 = ux[i] * hx + uy[i] * hy, sin0 = hx * uy[i] - hy * ux[i];
    const float big = 1.0f + std::fabs(cos0);
    const float wdt = w * k.dt;
    const float e = portable::exp(wdt < 30.0f ? -wdt : -30.0f);
    const float over = e * (cos0 < 0.0f ? big : sin0), under = cos0 < 0.0f ? sin0 : big;
    const float inv = 1.0f / (under * under + over * over);
    const float cos1 = (under * under - over * over) * inv, sin1 = 2.0f * over * under * inv;

    // Ornstein-Uhlenbeck noise of stiffness w cos delta.
    const float a = 2.0f * wdt * cos1;
    const bool tiny = std::fabs(a) < 0.01f;
    const float relaxed =
        tiny ? 1.0f - a * (0.5f - a * (1.0f / 6.0f)) : (1.0f - portable::exp(-a)) / (tiny ? 1.0f : a);
    const float variance = k.spread_r * (relaxed < 20.0f ? relaxed : 20.0f);
    const auto turn = portable::sincos(std::sqrt(variance * turn_square) * turn_cos);
    const float cos2 = cos1 * turn.cos - sin1 * turn.sin, sin2 = sin1 * turn.cos + cos1 * turn.sin;
    float vx = hx * cos2 - hy * sin2, vy = hy * cos2 + hx * sin2;
    const float unit = 1.5f - 0.5f * (vx * vx + vy * vy);  // one Newton step keeps |u| = 1
    vx *= unit;
    vy *= unit;

    const float half = k.half_step * speed[i];
    to_x[i] = x[i] + (half * (ux[i] + vx) + move_radius * move_angle.cos);
    to_y[i] = y[i] + (half * (uy[i] + vy) + move_radius * move_angle.sin);
    ux[i] = vx;
    uy[i] = vy;
  }
}

using DipoleSchema = Schema<Dipole::Params>;
using DipoleParams = Dipole::Params;

// Parameters of turning and diffusion.
void describe_body(DipoleSchema& s) {
  s.add("moment", &DipoleParams::moment,
        {.unit = "A m^2",
         .min = 0,
         .max = 1e-12,
         .doc = "Median magnetic moment of a cell",
         .source = "IT-1: about ten 75 nm magnetite crystals, estimate (B2), assumed",
         .role = Role::coupling})
      .add("moment_spread", &DipoleParams::moment_spread,
           {.min = 0,
            .max = 2,
            .doc = "Standard deviation of the logarithm of the moment between cells",
            .source = "assumed"})
      .add("radius", &DipoleParams::radius,
           {.unit = "m",
            .min = 1e-8,
            .max = 1e-4,
            .doc = "Radius of the sphere with the same drag as the cell",
            .source = "thesis: 1.4 um across"})
      .add("drag_factor", &DipoleParams::drag_factor,
           {.min = 0.1,
            .max = 1e4,
            .doc = "Rotational drag relative to a sphere without flagella, 8 pi eta R^3; flagella increase "
                   "it by 1 to 3",
            .source = "assumed 1 (B1)"})
      .add("viscosity", &DipoleParams::viscosity,
           {.unit = "Pa s",
            .min = 1e-5,
            .max = 10,
            .doc = "Viscosity of the medium",
            .source = "water at 25 C"})
      .add("temperature", &DipoleParams::temperature,
           {.unit = "K", .min = 1, .max = 500, .doc = "Temperature, for the diffusion constants"})
      .add(
          "rotational_diffusion", &DipoleParams::rotational_diffusion,
          {.unit = "1/s", .min = 0, .max = 1e4, .doc = "Rotational diffusion coefficient; default: kT / f_r"})
      .add("translational_diffusion", &DipoleParams::translational_diffusion,
           {.unit = "m^2/s",
            .min = 0,
            .max = 1e-6,
            .doc = "Translational diffusion coefficient; default: kT / f_t"});
}

// Parameters of speeds and random turning.
void describe_swimming(DipoleSchema& s) {
  s.add("speed", &DipoleParams::speed,
        {.unit = "m/s",
         .min = 0,
         .max = 1e-2,
         .doc = "Mean swimming speed",
         .source = "thesis: 186 um/s",
         .role = Role::speed})
      .add("speed_sd", &DipoleParams::speed_sd,
           {.unit = "m/s",
            .min = 0,
            .max = 1e-2,
            .doc = "Standard deviation of speed between cells, before truncation",
            .source = "assumed, so that 99.5 % of the cells are slower than 300 um/s (B4)"})
      .add("speed_max", &DipoleParams::speed_max,
           {.unit = "m/s",
            .min = 0,
            .max = 1e-2,
            .doc = "Maximum speed; the normal distribution is truncated to [0, speed_max]",
            .source = "assumed (B4)"})
      .add("motile", &DipoleParams::motile,
           {.min = 0,
            .max = 1,
            .doc = "Fraction of motile cells; the others turn with the field and diffuse, but do not swim",
            .source = "assumed",
            .title = "Motile fraction"})
      .add("reversal_rate", &DipoleParams::reversal_rate,
           {.unit = "1/s",
            .min = 0,
            .max = 1e3,
            .doc = "Rate at which a cell reverses its motor and swims backwards"})
      .add("tumble_rate", &DipoleParams::tumble_rate,
           {.unit = "1/s", .min = 0, .max = 1e3, .doc = "Rate of tumbles"})
      .add("tumble_sd", &DipoleParams::tumble_sd,
           {.min = 0,
            .max = 100,
            .doc = "Standard deviation of the tumble angle in rad; default: uniform distribution"});
}

void add_strains(DipoleSchema& s) {
  const DipoleParams msr1{.moment = 2.0e-16,
                          .moment_spread = 0.3,
                          .radius = 1.5e-6,
                          .drag_factor = 3.6,
                          .speed = 45e-6,
                          .speed_sd = 8e-6,
                          .speed_max = 80e-6};
  const DipoleParams mc1{.moment = 2e-15,
                         .moment_spread = 0.3,
                         .radius = 0.75e-6,
                         .speed = 300e-6,
                         .speed_sd = 70e-6,
                         .speed_max = 550e-6};
  s.preset("IT-1", {.moment_spread = 0.3},
           "Magnetofaba australis IT-1, the thesis's M. itaipuensis: speed and size from the thesis; "
           "moment and spreads assumed (B2, B4)")
      .preset("MSR-1", msr1,
              "Magnetospirillum gryphiswaldense: moment (2.0 +- 0.6)e-16 A m^2 (Reufer et al., arXiv "
              "1307.2459), drag set so that it turns at 0.74 rad/(mT s) (Pichel et al., arXiv "
              "1710.00405), speed 30-60 um/s without a source; spreads assumed")
      .preset("MC-1", mc1,
              "Magnetococcus marinus: speeds 100-500 um/s (Bente et al. 2020, eLife); moment and spreads "
              "assumed");
}

// Settings with which no cell swims, or none turns.
void add_notes(DipoleSchema& s) {
  s.note([](const DipoleParams& p) -> std::string {
     if (p.moment > 0) return {};
     return "moment is 0: the field does not turn the cells, and the coils cannot steer them; set a moment";
   })
      .note([](const DipoleParams& p) -> std::string {
        if (p.motile == 0)
          return "motile is 0: no cell swims; the field turns the cells but does not move them; increase "
                 "motile";
        if (p.speed > 0) return {};
        if (p.speed_sd == 0 || p.speed_max == 0)
          return "speed is 0: the cells do not swim; the field turns them but does not move them; increase "
                 "speed";
        return fmt::format(
            "speed is 0, but speed_sd is {:g} um/s: the cells swim at speeds between 0 and {:g} um/s; set "
            "speed_sd = 0 for cells that do not swim",
            1e6 * p.speed_sd, 1e6 * p.speed_max);
      })
      .note([](const DipoleParams& p) -> std::string {
        constexpr double kMelting = 273.15, kBoiling = 373.15;  // K, of water at normal pressure
        if (p.temperature >= kMelting && p.temperature <= kBoiling) return {};
        return fmt::format(
            "temperature is {:g} K, but water is liquid only between {} K and {} K; 20 degC is 293.15 K",
            p.temperature, kMelting, kBoiling);
      });
}

Schema<Dipole::Params> Dipole::schema() {
  Schema<Params> s("dipole", "Self-propelled magnetic dipole with rotational and translational diffusion");
  describe_body(s);
  describe_swimming(s);
  add_strains(s);
  add_notes(s);
  s.check([](const Params& p) -> std::string {
     if (p.speed > p.speed_max)
       return fmt::format(
           "speed = {:g} um/s is above speed_max = {:g} um/s; reduce speed or increase speed_max",
           1e6 * p.speed, 1e6 * p.speed_max);
     return {};
   })
      .validity(
          "The model is planar. It has no helical paths, no flagellar limit of turning, no hydrodynamic "
          "interaction and no field-gradient force (0.05 % of the thrust at 1 T/m).");
  return s;
}

// f_r, N m s.
double rotational_drag(const DipoleParams& p) {
  return p.drag_factor * 8 * portable::kPi * p.viscosity * p.radius * p.radius * p.radius;
}
// D_r in 1/s and D_t in m^2/s, including overrides.
double rotational_diffusion(const DipoleParams& p) {
  return p.rotational_diffusion.value_or(kBoltzmann * p.temperature / rotational_drag(p));
}
double translational_diffusion(const DipoleParams& p) {
  return p.translational_diffusion.value_or(kBoltzmann * p.temperature /
                                            (6 * portable::kPi * p.viscosity * p.radius));
}

Dipole::Dipole(const Params& p, const ModelContext&)
    : p_(p),
      turning_(p.moment / rotational_drag(p)),
      d_r_(rotational_diffusion(p)),
      d_t_(translational_diffusion(p)) {}

std::vector<ColumnSpec> Dipole::columns() const {
  return {{"ux", "1", "heading, component to the right"},
          {"uy", "1", "heading, component upwards"},
          {"speed", "m/s", "swimming speed, negative while swimming backwards"},
          {"turning", "rad/(s T)", "turning rate per tesla, m / f_r"}};
}

void Dipole::start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const {
  auto ux = s.agents["ux"], uy = s.agents["uy"], speed = s.agents["speed"], turning = s.agents["turning"];
  for (std::size_t i = begin; i < end; ++i) {
    const auto id = std::uint32_t(i);
    const auto w = draw(seed, kBirthDraws, id, 0);
    const auto heading = portable::sincos(float(std::int32_t(w[0]) >> 8) * (portable::kPiF * 0x1p-23f));
    ux[i] = heading.cos;
    uy[i] = heading.sin;
    turning[i] = float(turning_ * portable::exp(p_.moment_spread * double(normals(w[1], w[2])[0])));
    double v = p_.speed;
    if (p_.speed_sd > 0) {
      std::uint32_t attempt = 0;
      do {
        const auto u = draw(seed, kBirthDraws, id, ++attempt);
        v = p_.speed + p_.speed_sd * double(normals(u[0], u[1])[0]);
      } while ((v < 0 || v > p_.speed_max) && attempt < 1000);
      v = std::clamp(v, 0.0, p_.speed_max);
    }
    const double draw_motile = (double(w[3]) + 0.5) * 0x1p-32;
    speed[i] = draw_motile < p_.motile ? float(v) : 0.0F;
  }
}

void Dipole::step(State& s, const StepContext& c) const {
  auto& a = s.agents;
  const std::size_t n = c.end - c.begin;
  if (p_.reversal_rate > 0 || p_.tumble_rate > 0) reorient(s, c);
  const Constants k{float(c.dt), float(2 * d_r_ * c.dt), float(std::sqrt(2 * d_t_ * c.dt)),
                    float(c.dt / 2) * c.speed_factor};
  const float *response = a["response"].data(), *turning = a["turning"].data(), *speed = a["speed"].data(),
              *x = a["x"].data(), *y = a["y"].data();
  float *ux = a["ux"].data(), *uy = a["uy"].data();
  for_rows(c.seed, Stream::motion, c.begin, n, std::uint32_t(s.step),
           [&](std::size_t i, std::size_t count, const PhiloxRow& row) {
             const std::size_t j = c.begin + i;
             swim({&c.bx[i], &c.by[i], response + j, turning + j, speed + j, x + j, y + j, ux + j, uy + j,
                   &c.to_x[j], &c.to_y[j]},
                  k, row, count);
           });
}

// Reversals and tumbles are rare: a separate loop keeps their branches out of the vectorised one.
void Dipole::reorient(State& s, const StepContext& c) const {
  auto ux = s.agents["ux"], uy = s.agents["uy"], speed = s.agents["speed"];
  // an odd number of reversals within dt changes the sign
  const auto p_reverse = float(0.5 * (1 - portable::exp(-2 * p_.reversal_rate * c.dt)));
  const auto p_tumble = float(1 - portable::exp(-p_.tumble_rate * c.dt));
  for (std::size_t i = c.begin; i < c.end; ++i) {
    const auto w = draw(c.seed, kReorientDraws, std::uint32_t(i), std::uint32_t(s.step));
    if (uniform(w[0]) < p_reverse) speed[i] = -speed[i];
    if (uniform(w[1]) >= p_tumble) continue;
    const float angle = p_.tumble_sd ? float(*p_.tumble_sd) * normals(w[2], w[3])[0]
                                     : float(std::int32_t(w[2]) >> 8) * (portable::kPiF * 0x1p-23f);
    const auto t = portable::sincos(angle);
    const float x = ux[i], y = uy[i];
    ux[i] = x * t.cos - y * t.sin;
    uy[i] = x * t.sin + y * t.cos;
  }
}

double Dipole::longest_step(double b_max) const {
  // At most 0.5 rad of turning (bias 0.1 %, D1) and 0.02 rad^2 of diffusion per step: with weak alignment the
  // splitting of torque and noise costs 0.3 D_r dt of 1 - <cos>.
  double longest = 0.1;
  if (turning_ * b_max > 0) longest = std::min(longest, 0.5 / (turning_ * b_max));
  if (d_r_ > 0) longest = std::min(longest, 0.02 / d_r_);
  return longest;
}

// <cos delta> of cells with random headings grows by at most w_B / 2 per second, and rotational diffusion
// limits it to I_1(k) / I_0(k) <= k / 2 with k = w_B / D_r, which is m B / kT unless D_r is given.
WeakestField Dipole::weakest_field(double time) const {
  constexpr double kAlignment = 0.01;
  if (turning_ == 0) return {std::numeric_limits<double>::infinity(), "the cells have no moment"};
  const bool thermal = d_r_ > 1 / time;
  return {2 * kAlignment * std::max(d_r_, 1 / time) / turning_,
          thermal ? "rotational diffusion keeps the mean alignment of cells with a weaker field below 1 %"
                  : "the mean alignment in a weaker field stays below 1 % until the end of the run"};
}

}  // namespace

void add_dipole(ModelRegistry& r) { r.add<Dipole>(); }

}  // namespace faba
