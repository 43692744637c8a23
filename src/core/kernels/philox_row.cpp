#include "core/kernels/philox_row.h"

#include <vector>

#if defined(__x86_64__)
// GCC 12 warns about placeholder operands in its own header (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#endif

namespace faba {
namespace {

void plain(std::uint32_t first, std::uint32_t step, std::uint32_t stream, std::uint64_t seed, std::size_t n,
           PhiloxRow& row) {
  for (std::size_t i = 0; i < n; ++i) {
    std::uint32_t c0 = first + std::uint32_t(i), c1 = step, c2 = stream, c3 = 0;
    philox(c0, c1, c2, c3, std::uint32_t(seed), std::uint32_t(seed >> 32));
    row.w0[i] = c0;
    row.w1[i] = c1;
    row.w2[i] = c2;
    row.w3[i] = c3;
  }
}

#if defined(__x86_64__)
// A word sits in the lower half of each 64-bit lane; the multiplication ignores whatever is in the upper
// half, so lower halves of products need no masking. Two vectors at a time hide the multiplier's latency.
[[gnu::target("avx512f")]] void avx512(std::uint32_t first, std::uint32_t step, std::uint32_t stream,
                                       std::uint64_t seed, std::size_t n, PhiloxRow& row) {
  const __m512i m0 = _mm512_set1_epi64(kPhiloxM0), m1 = _mm512_set1_epi64(kPhiloxM1);
  for (std::size_t i = 0; i < n; i += 16) {
    __m512i w[2][4];
    for (int h = 0; h < 2; ++h) {
      w[h][0] = _mm512_add_epi64(_mm512_set1_epi64(first + std::int64_t(i) + std::int64_t{8} * h),
                                 _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0));
      w[h][1] = _mm512_set1_epi64(step);
      w[h][2] = _mm512_set1_epi64(stream);
      w[h][3] = _mm512_setzero_si512();
    }
    std::uint32_t k0 = std::uint32_t(seed), k1 = std::uint32_t(seed >> 32);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round, k0 += kPhiloxW0, k1 += kPhiloxW1) {
      const __m512i key0 = _mm512_set1_epi64(k0), key1 = _mm512_set1_epi64(k1);
#pragma GCC unroll 2
      for (auto& v : w) {
        const __m512i p0 = _mm512_mul_epu32(v[0], m0), p1 = _mm512_mul_epu32(v[2], m1);
        v[0] = _mm512_xor_si512(_mm512_xor_si512(_mm512_srli_epi64(p1, 32), v[1]), key0);
        v[2] = _mm512_xor_si512(_mm512_xor_si512(_mm512_srli_epi64(p0, 32), v[3]), key1);
        v[1] = p1;
        v[3] = p0;
      }
    }
    std::uint32_t* const out[4] = {&row.w0[i], &row.w1[i], &row.w2[i], &row.w3[i]};
    for (int h = 0; h < 2; ++h)
      for (int k = 0; k < 4; ++k)
        _mm256_store_si256(reinterpret_cast<__m256i*>(out[k] + std::ptrdiff_t{8} * h),
                           _mm512_cvtepi64_epi32(w[h][k]));
  }
}

[[gnu::target("avx2")]] void avx2(std::uint32_t first, std::uint32_t step, std::uint32_t stream,
                                  std::uint64_t seed, std::size_t n, PhiloxRow& row) {
  const __m256i m0 = _mm256_set1_epi64x(kPhiloxM0), m1 = _mm256_set1_epi64x(kPhiloxM1);
  const __m256i even = _mm256_set_epi32(7, 5, 3, 1, 6, 4, 2, 0);
  for (std::size_t i = 0; i < n; i += 8) {
    __m256i w[2][4];
    for (int h = 0; h < 2; ++h) {
      w[h][0] = _mm256_add_epi64(_mm256_set1_epi64x(first + std::int64_t(i) + std::int64_t{4} * h),
                                 _mm256_set_epi64x(3, 2, 1, 0));
      w[h][1] = _mm256_set1_epi64x(step);
      w[h][2] = _mm256_set1_epi64x(stream);
      w[h][3] = _mm256_setzero_si256();
    }
    std::uint32_t k0 = std::uint32_t(seed), k1 = std::uint32_t(seed >> 32);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round, k0 += kPhiloxW0, k1 += kPhiloxW1) {
      const __m256i key0 = _mm256_set1_epi64x(k0), key1 = _mm256_set1_epi64x(k1);
#pragma GCC unroll 2
      for (auto& v : w) {
        const __m256i p0 = _mm256_mul_epu32(v[0], m0), p1 = _mm256_mul_epu32(v[2], m1);
        v[0] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p1, 32), v[1]), key0);
        v[2] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p0, 32), v[3]), key1);
        v[1] = p1;
        v[3] = p0;
      }
    }
    std::uint32_t* const out[4] = {&row.w0[i], &row.w1[i], &row.w2[i], &row.w3[i]};
    for (int h = 0; h < 2; ++h)
      for (int k = 0; k < 4; ++k)
        _mm_store_si128(reinterpret_cast<__m128i*>(out[k] + std::ptrdiff_t{4} * h),
                        _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(w[h][k], even)));
  }
}
#endif

}  // namespace

std::span<const PhiloxKernel> philox_kernels() {
  static const std::vector<PhiloxKernel> all = [] {
    std::vector<PhiloxKernel> k;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) k.push_back({"AVX-512", avx512});
    if (__builtin_cpu_supports("avx2")) k.push_back({"AVX2", avx2});
#endif
    k.push_back({"plain", plain});
    return k;
  }();
  return all;
}

void draw_row(std::uint64_t seed, Stream stream, std::uint32_t first, std::uint32_t step, std::size_t n,
              PhiloxRow& row) {
  static const auto fastest = philox_kernels().front().row;
  fastest(first, step, std::uint32_t(stream), seed, n, row);
}

}  // namespace faba
