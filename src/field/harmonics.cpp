#include "field/harmonics.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::size_t kMostPoints = 8000;  // more points do not improve the fit and take more time
constexpr double kNoise = 1e-13;           // rounding error as a fraction of the largest pivot

using Complex = std::complex<double>;

// R_l^m = r^l P_l^m e^(i m phi) / (l + m)!, whose derivatives are neighbouring terms:
//   d/dz R_l^m = R_(l-1)^m,  (d/dx + i d/dy) R_l^m = -R_(l-1)^(m+1),  (d/dx - i d/dy) R_l^m = R_(l-1)^(m-1).
struct Solid {
  static std::size_t index(int l, int m) { return std::size_t(l) * std::size_t(l + 1) / 2 + std::size_t(m); }
  std::vector<Complex> value;
  Complex of(int l, int m) const {
    if (std::abs(m) > l) return 0;
    return m < 0 ? -std::conj(value[index(l, -m)]) : value[index(l, m)];  // only m = -1 is used
  }
  Solid(Vec3 at, int degree) : value(index(degree, degree) + 1) {
    const double r2 = at.x * at.x + at.y * at.y + at.z * at.z;
    value[0] = 1;
    for (int m = 0; m <= degree; ++m) {
      if (m > 0) {
        const Complex before = value[index(m - 1, m - 1)];
        value[index(m, m)] = Complex(at.x * before.real() - at.y * before.imag(),
                                     at.x * before.imag() + at.y * before.real()) /
                             double(2 * m);
      }
      for (int l = m + 1; l <= degree; ++l) {
        Complex v = (2 * l - 1) * at.z * value[index(l - 1, m)];
        if (l - 2 >= m) v -= r2 * value[index(l - 2, m)];
        value[index(l, m)] = v / double((l + m) * (l - m));
      }
    }
  }
};

/// Schmidt's factor over that of Solid: sqrt((2 - [m = 0]) (l - m)! (l + m)!).
class Schmidt {
 public:
  Schmidt() {
    std::array<double, 2 * kMostHarmonicDegree + 1> factorial{1};
    for (std::size_t i = 1; i < factorial.size(); ++i) factorial[i] = factorial[i - 1] * double(i);
    for (int l = 0; l <= kMostHarmonicDegree; ++l)
      for (int m = 0; m <= l; ++m)
        factor_[Solid::index(l, m)] = std::sqrt((m ? 2 : 1) * factorial[std::size_t(l) - std::size_t(m)] *
                                                factorial[std::size_t(l) + std::size_t(m)]);
  }
  double operator()(int l, int m) const { return factor_[Solid::index(l, m)]; }

 private:
  std::array<double, std::size_t(kMostHarmonicDegree + 1) * std::size_t(kMostHarmonicDegree + 2) / 2>
      factor_{};
};

/// Normal equations of a least-squares fit over a part of the points.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double square = 0;  ///< of all measurements
  double count = 0;

  explicit Normal(int degree)
      : matrix(Eigen::MatrixXd::Zero(size(degree), size(degree))),
        right(Eigen::VectorXd::Zero(size(degree))) {}
  static Eigen::Index size(int degree) { return Eigen::Index(harmonic_terms(degree)); }
  void add(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values) {
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    right += rows.transpose() * values;
    square += values.squaredNorm();
    count += double(values.size());
  }
  Normal& operator+=(const Normal& o) {
    matrix += o.matrix;
    right += o.right;
    square += o.square;
    count += o.count;
    return *this;
  }
  /// Least squares up to `degree`; coefficients that the data do not determine are 0.
  Eigen::VectorXd solve(int degree) const {
    const Eigen::Index terms = size(degree);
    Eigen::MatrixXd m = matrix.topLeftCorner(terms, terms).selfadjointView<Eigen::Lower>();
    m.diagonal().array() += kNoise * m.diagonal().maxCoeff();
    return m.ldlt().solve(right.head(terms));
  }
  double rms(const Eigen::VectorXd& c) const {
    const Eigen::MatrixXd m = matrix.topLeftCorner(c.size(), c.size()).selfadjointView<Eigen::Lower>();
    return std::sqrt(std::max(0.0, square - 2 * c.dot(right.head(c.size())) + c.dot(m * c)) /
                     std::max(count, 1.0));
  }
};

// Indices of at most kMostPoints points, evenly spaced.
std::vector<std::size_t> chosen(std::size_t points) {
  const std::size_t step = std::max<std::size_t>(1, (points + kMostPoints - 1) / kMostPoints);
  std::vector<std::size_t> i;
  for (std::size_t k = 0; k < points; k += step) i.push_back(k);
  return i;
}

// Centre and radius of the bounding box of the points.
void place(const std::vector<Vec3>& at, Harmonics& field) {
  Vec3 low = at[0], high = low;
  for (const Vec3& p : at) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 half = 0.5 * (high - low);
  field.centre = 0.5 * (low + high);
  field.radius = norm(half);
}

// Whether the points extend along at least two directions.
bool spans_a_plane(const std::vector<Vec3>& at) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Vec3& p : at) mean += Eigen::Vector3d(p.x, p.y, p.z) / double(at.size());
  for (const Vec3& p : at) {
    const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - mean;
    spread += d * d.transpose();
  }
  const Eigen::Vector3d size = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return size[1] > 1e-6 * size[2];  // width at least 1/1000 of the length
}

Normal normal(const FieldData& data, const std::vector<std::size_t>& points, const Harmonics& about,
              int degree) {
  constexpr std::size_t kBlock = 256;
  Normal sums(degree);
  std::vector<Vec3> term(harmonic_terms(degree));
  Eigen::MatrixXd rows(Eigen::Index(3 * kBlock), Normal::size(degree));
  Eigen::VectorXd values(rows.rows());
  Eigen::Index n = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const std::size_t i = points[j];
    harmonic_fields((1 / about.radius) * (data.at[i] - about.centre), degree, term);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [k](const Vec3& v) { return k == 0 ? v.x : k == 1 ? v.y : v.z; };
      if (!data.given[k]) continue;
      for (std::size_t t = 0; t < term.size(); ++t) rows(n, Eigen::Index(t)) = component(term[t]);
      values[n++] = component(data.b[i]);
    }
    if (j + 1 < points.size() && n + 3 <= rows.rows()) continue;
    sums.add(rows.topRows(n), values.head(n));
    n = 0;
  }
  return sums;
}

}  // namespace

int Harmonics::degree() const { return int(std::lround(std::sqrt(double(coefficients.size() + 1)))) - 1; }

void harmonic_fields(Vec3 at, int degree, std::span<Vec3> out) {
  static const Schmidt schmidt;
  const Solid below(at, degree - 1);
  std::size_t next = 0;
  for (int l = 1; l <= degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const Complex less = below.of(l - 1, m - 1), more = below.of(l - 1, m + 1), same = below.of(l - 1, m);
      const double f = schmidt(l, m);
      const Complex dx = 0.5 * (less - more), sum = less + more;
      out[next++] = {f * dx.real(), -0.5 * f * sum.imag(), f * same.real()};
      if (m > 0) out[next++] = {f * dx.imag(), 0.5 * f * sum.real(), f * same.imag()};
    }
}

Vec3 Harmonics::at(Vec3 point) const {
  std::vector<Vec3> term(coefficients.size());
  harmonic_fields((1 / radius) * (point - centre), degree(), term);
  Vec3 b;
  for (std::size_t i = 0; i < term.size(); ++i) b = b + coefficients[i] * term[i];
  return b;
}

HarmonicFit fit_harmonics(const FieldData& data) {
  const std::vector<std::size_t> points = chosen(data.at.size());
  const auto given = std::size_t(std::count(data.given.begin(), data.given.end(), true));
  if (points.size() < 8)
    throw Error(Errc::input, data.source,
                fmt::format("has {} points; a field needs at least 8", points.size()));
  HarmonicFit fit;
  place(data.at, fit.field);
  if (!spans_a_plane(data.at))
    throw Error(Errc::input, data.source,
                "all points are on one line; a field needs points in a plane or, preferably, in a volume");
  int most = 1;
  while (most < kMostHarmonicDegree && 2 * harmonic_terms(most + 1) <= given * points.size()) ++most;

  std::vector<std::size_t> training, validation;  // hashed index: one fifth, not aligned with a regular map
  for (const std::size_t i : points)
    ((std::uint32_t(i) * 2654435761u >> 8) % 5 == 0 ? validation : training).push_back(i);
  Normal all = normal(data, training, fit.field, most);
  const Normal test = normal(data, validation, fit.field, most);
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int degree = 1; degree <= most; ++degree) {
    const double off = test.rms(all.solve(degree));
    if (off < 0.95 * least) {  // a higher degree must reduce the residual by 5 %
      least = off;
      best = degree;
    }
  }
  all += test;
  const Eigen::VectorXd c = all.solve(best);
  fit.field.coefficients.assign(c.begin(), c.end());
  fit.rms = all.rms(c);
  fit.rms_field = std::sqrt(all.square / all.count);
  return fit;
}

}  // namespace faba
