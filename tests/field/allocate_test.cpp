#include "field/allocate.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace faba;

namespace {

// Coils with a given uniform field per ampere.
class Given final : public Field {
 public:
  explicit Given(std::vector<Vec3> b) : b_(std::move(b)) {}
  std::size_t coils() const override { return b_.size(); }
  void per_ampere(std::size_t coil, std::span<const Vec3>, std::span<Vec3> b) const override {
    std::fill(b.begin(), b.end(), b_[coil]);
  }
  Circuit circuit(std::size_t) const override { return {}; }
  Vec3 ambient() const override { return {0, 0, 1e-5}; }

 private:
  std::vector<Vec3> b_;
};

}  // namespace

TEST_CASE("the wanted field is made with the least-norm currents") {
  const Given f({{1, 0.2, 0}, {-0.3, 2, 1}, {0.5, 0.5, 0}, {0, -1, 2}});
  const Vec2 wanted{3e-4, -7e-4};
  const auto i = allocate(f, {}, wanted);
  const Vec3 b = f.at({}, i) - f.ambient();
  CHECK(b.x == doctest::Approx(wanted.x).epsilon(1e-12));
  CHECK(b.y == doctest::Approx(wanted.y).epsilon(1e-12));
  // least norm: the currents are a combination of the two rows of the basis, orthogonal to its null space
  for (const auto& null : {std::vector<double>{-0.65, -0.5, 1, -0.63}}) {
    std::vector<double> n = null;
    n[0] = -(n[1] * -0.3 + n[2] * 0.5);
    n[3] = n[0] * 0.2 + n[1] * 2 + n[2] * 0.5;
    double along = 0;
    for (std::size_t k = 0; k < 4; ++k) along += n[k] * i[k];
    CHECK(std::fabs(along) < 1e-15);
  }
}

TEST_CASE("parallel coils make the nearest field; coils without in-plane field give zero currents") {
  const Given line({{2, 0, 0}, {1, 0, 0}});
  const auto i = allocate(line, {}, {1, 1});
  CHECK(line.at({}, i).x == doctest::Approx(1));
  CHECK(line.at({}, i).y == 0);
  CHECK(allocate(Given({{0, 0, 5}}), {}, {1, 1}) == std::vector<double>{0.0});
}
