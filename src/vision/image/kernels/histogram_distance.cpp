#include "vision/image/kernels/histogram_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/vectorised.h"
#include "core/wide.h"

namespace faba {
namespace {

// z^-m for normal z > 0 with relative error 5e-15 (1 + |m ln z|): atanh series to s^17 (truncation error
// 1e-16) and exponential series of x/4 to r^8 (3e-15). pow() of the C library would take 90 % of the time of
// the distance. Full blocks of lanes are read and written.
template <int bytes>
[[gnu::always_inline]] inline void negative_power_in(const double* z, double m, double* out, std::size_t n) {
  using Lanes = typename Wide<double, bytes>::type;
  using Bits = typename Wide<std::uint64_t, bytes>::type;
  constexpr std::size_t kLanes = bytes / sizeof(double);
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  for (std::size_t i = 0; i < n; i += kLanes) {
    const Bits bits = *reinterpret_cast<const Bits*>(z + i);
    // z = f 2^e with f in [sqrt(1/2), sqrt(2))
    const Bits above = (bits - 0x3fe6a09e667f3bcdull) & 0xfff0000000000000ull;
    const Lanes f = reinterpret_cast<Lanes>(bits - above);
    const Lanes e =
        reinterpret_cast<Lanes>(((above >> 52) ^ 0x800) + 0x4338000000000000ull) - (kShift + 2048);
    const Lanes s = (f - 1) / (f + 1), q = s * s;
    Lanes sum = q * (1.0 / 17) + 1.0 / 15;
    sum = sum * q + 1.0 / 13;
    sum = sum * q + 1.0 / 11;
    sum = sum * q + 1.0 / 9;
    sum = sum * q + 1.0 / 7;
    sum = sum * q + 1.0 / 5;
    sum = sum * q + 1.0 / 3;
    const Lanes log2 = e + (s + s * q * sum) * 2.8853900817779268147;  // 2 / ln 2
    const Lanes x = log2 * -m, integer_part = (x + kShift) - kShift,
                r = (x - integer_part) * (0.69314718055994530942 / 4);
    Lanes y = r * (1.0 / 40320) + 1.0 / 5040;
    y = y * r + 1.0 / 720;
    y = y * r + 1.0 / 120;
    y = y * r + 1.0 / 24;
    y = y * r + 1.0 / 6;
    y = y * r + 0.5;
    y = y * r + 1;
    y = y * r + 1;
    y = y * y;
    y = y * y;
    const Bits power = (reinterpret_cast<Bits>(integer_part + (kShift + 1023)) & 0x7ff) << 52;
    *reinterpret_cast<Lanes*>(out + i) = y * reinterpret_cast<Lanes>(power);
  }
}
FABA_WIDE(negative_power, (const double* z, double m, double* out, std::size_t n), (z, m, out, n))

/// out_i = sum over k of taps_|k| in_i+k. `in` is readable and `out` writable up to a full block beyond the
/// end; `in` also by the number of taps on both sides.
constexpr std::size_t kBlock = 32;
template <int bytes>
[[gnu::always_inline]] inline void add_taps_in(const double* in, double* out, std::size_t n,
                                               const double* taps, std::size_t count) {
  using Lanes = typename Wide<double, bytes>::type;
  constexpr std::size_t kLanes = bytes / sizeof(double);
  const auto at = [](const double* p) { return reinterpret_cast<const Lanes*>(p); };
  for (std::size_t i = 0; i < n; i += 4 * kLanes) {
    const double* here = in + i;
    const Lanes* middle = at(here);
    Lanes a = middle[0] * taps[0], b = middle[1] * taps[0], c = middle[2] * taps[0], d = middle[3] * taps[0];
    for (std::size_t k = 1; k < count; ++k) {
      const Lanes *left = at(here - k), *right = at(here + k);
      a += (left[0] + right[0]) * taps[k];
      b += (left[1] + right[1]) * taps[k];
      c += (left[2] + right[2]) * taps[k];
      d += (left[3] + right[3]) * taps[k];
    }
    Lanes* to = reinterpret_cast<Lanes*>(out + i);
    to[0] = a;
    to[1] = b;
    to[2] = c;
    to[3] = d;
  }
}
FABA_WIDE(add_taps, (const double* in, double* out, std::size_t n, const double* taps, std::size_t count),
          (in, out, n, taps, count))

/// Eight interleaved partial sums, so that additions do not wait for each other.
FABA_VECTORISED double product(const double* a, const double* b, std::size_t n) {
  double part[8] = {};
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (std::size_t j = 0; j < 8; ++j) part[j] += a[i + j] * b[i + j];
  double sum = ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
  for (; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

FABA_VECTORISED void add(const double* a, const double* b, double* out, std::size_t n) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] + b[i];
}
/// p - q where the weight is non-zero. 0/0 = 0: where the weight vanishes, so does P - Q. Weights too small
/// for negative_power count as zero.
FABA_VECTORISED void differences(const double* p, const double* q, double* weight, double* out,
                                 std::size_t n) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) {
    const bool some = weight[i] >= 1e-300;
    out[i] = some ? p[i] - q[i] : 0;
    weight[i] = some ? weight[i] : 1;
  }
}
FABA_VECTORISED void multiply(double* a, const double* b, std::size_t n) {
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) a[i] *= b[i];
}

FABA_VECTORISED bool all_valid_bins(const double* h, std::size_t n) {
  std::uint64_t bad = 0;
  for (std::size_t i = 0; i < n; ++i) bad += h[i] >= 0 && h[i] <= 1.7976931348623157e308 ? 0 : 1;
  return bad == 0;
}

}  // namespace

BinSimilarity BinSimilarity::truncated_linear(double threshold) {
  if (!(threshold > 0) || !std::isfinite(threshold))
    throw Error(Errc::usage, "--threshold",
                fmt::format("{} is out of range; it must be a finite number above 0", threshold));
  BinSimilarity s;
  for (std::size_t k = 0; double(k) < threshold; ++k) {
    s.taps_.push_back(1 - double(k) / threshold);
    if (k == 1000000)
      throw Error(Errc::usage, "--threshold",
                  fmt::format("{} is out of range; it must be at most 1000000", threshold));
  }
  return s;
}

BinSimilarity BinSimilarity::given(std::vector<double> matrix, std::size_t n, const std::string& name) {
  if (n == 0 || matrix.size() != n * n)
    throw Error(Errc::input, name, "the similarity matrix must be square, with one row per bin");
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double a = matrix[i * n + j];
      if (!std::isfinite(a) || a < 0)
        throw Error(Errc::input, name,
                    fmt::format("row {}, column {}: {} is out of range; similarities must be finite and >= 0",
                                i + 1, j + 1, a));
      if (a > matrix[i * n + i])
        throw Error(Errc::input, name,
                    fmt::format("row {}, column {} exceeds the diagonal element of its row; a bin must not "
                                "be more similar to another bin than to itself",
                                i + 1, j + 1));
    }
  BinSimilarity s;
  s.bins_ = n;
  s.matrix_ = std::move(matrix);
  return s;
}

void BinSimilarity::apply(const double* in, double* out, std::size_t n) const {
  if (bins_ == 0) return add_taps(in, out, n, taps_.data(), std::min(taps_.size(), n));
  for (std::size_t i = 0; i < bins_; ++i) out[i] = product(&matrix_[i * bins_], in, bins_);
}

HistogramDistance::HistogramDistance(BinSimilarity similarity, double m)
    : similarity_(std::move(similarity)), m_(m) {
  if (!(m >= 0 && m < 1))
    throw Error(Errc::usage, "--m",
                fmt::format("{} is out of range; it must be at least 0 and less than 1", m));
}

double HistogramDistance::operator()(std::span<const double> p, std::span<const double> q) {
  const std::size_t n = p.size();
  if (q.size() != n)
    throw Error(
        Errc::input, "histogram",
        fmt::format("the histograms have {} and {} bins; they must have the same number", n, q.size()));
  if (similarity_.bins() != 0 && similarity_.bins() != n)
    throw Error(Errc::input, "histogram",
                fmt::format("has {} bins, but the similarity matrix has {}", n, similarity_.bins()));
  for (const auto h : {p, q})
    if (!all_valid_bins(h.data(), n))
      for (std::size_t i = 0; i < n; ++i)
        if (!(h[i] >= 0 && std::isfinite(h[i])))
          throw Error(Errc::input, "histogram",
                      fmt::format("bin {}: {} is out of range; values must be finite and >= 0", i + 1, h[i]));
  if (n == 0) return 0;
  // Buffers with zeros on both sides by the reach of the similarity; kept between calls.
  const std::size_t margin = similarity_.reach(n);
  if (n != bins_) {
    bins_ = n;
    sum_.assign(n + 2 * margin + kBlock, 0.0);
    d_.assign(n + 2 * margin + kBlock, 0.0);
    weight_.assign(n + kBlock, 1.0);
  }
  double *sum = &sum_[margin], *d = &d_[margin], *weight = weight_.data();
  add(p.data(), q.data(), sum, n);
  similarity_.apply(sum, weight, n);
  differences(p.data(), q.data(), weight, d, n);
  negative_power(weight, m_, weight, n);
  multiply(d, weight, n);
  similarity_.apply(d, weight, n);
  const double square = product(d, weight, n);
  return std::sqrt(square > 0 ? square : 0);  // negative only by rounding, for a positive definite A
}

}  // namespace faba
