#include "machine.h"

#include <array>

#include "core/kernels/philox_row.h"
#include "core/vectorised.h"

namespace faba::bench {
namespace {

constexpr std::size_t kBlock = 2048;  // as in World: the data of a block fit into the L1 cache

FABA_VECTORISED void sincos_block(const float* __restrict angle, float* __restrict s, float* __restrict c,
                                  std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const auto v = portable::sincos(angle[i]);
    s[i] = v.sin;
    c[i] = v.cos;
  }
}

FABA_VECTORISED void log_block(const float* __restrict u, float* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = portable::log(u[i]);
}

FABA_VECTORISED void traffic_block(float* __restrict x, float* __restrict y, float* __restrict ux,
                                   float* __restrict uy, const float* __restrict speed, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float a = ux[i], b = uy[i];
    x[i] += speed[i] * a;
    y[i] += speed[i] * b;
    ux[i] = b;  // rotation by 90 degrees, so that values stay bounded
    uy[i] = -a;
  }
}

FABA_VECTORISED void triad_block(float* __restrict a, const float* __restrict b, const float* __restrict c,
                                 std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 0.5f * c[i];
}

// Prevents the compiler from removing the computation of `*p`.
void keep(const void* p) { asm volatile("" : : "r"(p) : "memory"); }

}  // namespace

struct Machine::Memory {
  explicit Memory(std::size_t n) : x(n, 1.0f), y(n, 1.0f), ux(n, 0.8f), uy(n, 0.6f), speed(n, 0.1f) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto w = draw(1, Stream::camera, std::uint32_t(i), 0);
      unit[i] = uniform(w[0]);
      angle[i] = float(std::int32_t(w[1]) >> 8) * (portable::kPiF * 0x1p-23f);
    }
  }
  std::vector<float> x, y, ux, uy, speed;
  std::array<float, kBlock> angle, unit;
};

Machine::Machine(std::size_t agents, Pool& pool)
    : agents_(agents), pool_(pool), memory_(std::make_unique<Memory>(agents)) {}
Machine::~Machine() = default;

const std::vector<std::string>& Machine::names() {
  static const std::vector<std::string> all{"philox", "sincos", "log", "traffic", "triad"};
  return all;
}

void Machine::run(const std::string& name, int times) {
  Memory& m = *memory_;
  const auto each_block = [&](auto&& job) {
    for (int k = 0; k < times; ++k) pool_.for_blocks(agents_, kBlock, job);
  };
  if (name == "philox")
    each_block([&](std::size_t b, std::size_t e) {
      for_rows(1, Stream::motion, b, e - b, 7,
               [](std::size_t, std::size_t, const PhiloxRow& row) { keep(&row); });
    });
  else if (name == "sincos")
    each_block([&](std::size_t b, std::size_t e) {
      std::array<float, kBlock> s, c;
      sincos_block(m.angle.data(), s.data(), c.data(), e - b);
      keep(s.data());
      keep(c.data());
    });
  else if (name == "log")
    each_block([&](std::size_t b, std::size_t e) {
      std::array<float, kBlock> out;
      log_block(m.unit.data(), out.data(), e - b);
      keep(out.data());
    });
  else if (name == "traffic")
    each_block([&](std::size_t b, std::size_t e) {
      traffic_block(&m.x[b], &m.y[b], &m.ux[b], &m.uy[b], &m.speed[b], e - b);
    });
  else
    each_block([&](std::size_t b, std::size_t e) { triad_block(&m.x[b], &m.y[b], &m.ux[b], e - b); });
}

const char* vector_unit() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("x86-64-v4")) return "AVX-512";
  if (__builtin_cpu_supports("x86-64-v3")) return "AVX2";
  return "SSE2";
#else
  return "unknown";
#endif
}

}  // namespace faba::bench
