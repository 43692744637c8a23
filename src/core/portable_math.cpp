#include "core/portable_math.h"

#include <limits>

namespace faba::portable {
namespace {
constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;  // ln 2, split
}

double exp(double x) {
  if (x > 709) return std::numeric_limits<double>::infinity();
  if (x < -708) return 0;
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * kLn2High) - n * kLn2Low;  // |r| <= 0.347
  double term = 1, sum = 0;
  // Taylor, smallest terms first: 0.347^18 / 18! < 1e-24
  double terms[18];
  for (int k = 1; k <= 18; ++k) terms[k - 1] = term = term * r / k;
  for (int k = 17; k >= 0; --k) sum += terms[k];
  return (1 + sum) * bit_cast<double>(std::uint64_t(std::int64_t(n) + 1023) << 52);
}

double log(double x) {
  if (!(x > 0))
    return x == 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  int e = 0;
  double m = std::frexp(x, &e);  // exact
  if (m < 0.7071067811865476) {
    m *= 2;
    --e;
  }
  const double s = (m - 1) / (m + 1), z = s * s;  // ln m = 2 atanh s, |s| <= 0.1716
  double sum = 0;
  for (int k = 25; k >= 3; k -= 2) sum = (sum + 1.0 / k) * z;  // next term 0.1716^27 / 27 < 1e-22
  return e * kLn2High + (2 * (s + s * sum) + e * kLn2Low);
}

SinCosD sincos(double a) {
  const double q = std::floor(a * 0.63661977236758134308 + 0.5);
  const double r =
      ((a - q * 1.57079632673412561417) - q * 6.07710050630396597660e-11) - q * 2.02226624879595063154e-21;
  const double z = r * r;
  double s = 0, c = 0;
  for (int k = 21; k >= 3; k -= 2) s = (s + 1) * -z / (k * (k - 1));  // 0.786^23 / 23! < 1e-24
  for (int k = 20; k >= 2; k -= 2) c = (c + 1) * -z / (k * (k - 1));
  s = r + r * s;
  c = 1 + c;
  switch (std::int64_t(q) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double atan2(double y, double x) {
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == 0 && ay == 0) return 0;
  const bool steep = ay > ax;
  double t = steep ? ax / ay : ay / ax;
  // halving the angle twice maps t from [0, 1] to [0, 0.2], where the series converges quickly
  double scale = 1;
  for (int i = 0; i < 2; ++i) {
    t = t / (1 + std::sqrt(1 + t * t));
    scale *= 2;
  }
  const double z = t * t;
  double sum = 0;
  for (int k = 25; k >= 3; k -= 2) sum = (sum + 1.0 / k) * -z;  // 0.2^27 / 27 < 1e-20
  double a = scale * (t + t * sum);
  if (steep) a = kPi / 2 - a;
  if (x < 0) a = kPi - a;
  return y < 0 ? -a : a;
}

double normal_cdf(double x) {
  const double a = x < 0 ? -x : x, t = 1 / (1 + 0.2316419 * a);
  const double tail =
      0.3989422804014327 * exp(-0.5 * a * a) * t *
      (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
  return x < 0 ? tail : 1 - tail;
}

}  // namespace faba::portable
