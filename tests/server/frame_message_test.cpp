#include "server/shown/frame_message.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace faba;

namespace {

template <class T>
T at(const std::string& s, std::size_t offset) {
  T v;
  std::memcpy(&v, s.data() + offset, sizeof v);
  return v;
}

struct Swarm {
  std::vector<float> x, y, ux, uy, response;
  explicit Swarm(std::size_t n, double half_x, double half_y) {
    for (std::size_t i = 0; i < n; ++i) {
      const double a = double(i) * 0.754877666, b = double(i) * 0.569840291;  // low discrepancy
      x.push_back(float(half_x * (2 * (a - std::floor(a)) - 1)));
      y.push_back(float(half_y * (2 * (b - std::floor(b)) - 1)));
      const double turn = 0.37 * double(i);
      ux.push_back(float(std::cos(turn)));
      uy.push_back(float(std::sin(turn)));
      response.push_back(i % 3 ? 1.0F : 0.0F);
    }
  }
};

// A view of 200 x 100 px, 2 um per px, in an arena that extends 50 px beyond it on all sides.
FrameMessage message(const Swarm& s, const std::vector<double>& rows, const std::vector<float>& field) {
  FrameMessage m;
  m.run = 3;
  m.frame = 41;
  m.t = 2.75;
  m.view = {2e-6, 200, 100, {99.5, 49.5}};
  m.box = {-50, -50, 250, 150};
  m.x = s.x;
  m.y = s.y;
  m.ux = s.ux;
  m.uy = s.uy;
  m.response = s.response;
  m.rows = rows;
  m.columns = 3;
  m.field_columns = 2;
  m.field_rows = 1;
  m.field = field;
  return m;
}

}  // namespace

TEST_CASE("a frame message follows the protocol byte by byte") {
  const Swarm s(11, 2.9e-4, 1.9e-4);
  const std::vector<double> rows = {1, 2, 3, 4, 5, 6};
  const std::vector<float> field = {1e-4F, 0, 2e-4F, -1e-4F};
  const std::string b = encode_frame(message(s, rows, field));
  CHECK(b.substr(0, 4) == "FABA");
  CHECK(at<std::uint16_t>(b, 4) == 1);
  CHECK(at<std::uint16_t>(b, 6) == (1 | 4));
  CHECK(at<std::uint32_t>(b, 8) == 3);
  CHECK(at<std::uint32_t>(b, 12) == 11);
  CHECK(at<std::uint32_t>(b, 16) == 2);
  CHECK(at<std::uint16_t>(b, 24) == 2);
  CHECK(at<std::uint16_t>(b, 26) == 1);
  CHECK(at<std::uint64_t>(b, 32) == 41);
  CHECK(at<double>(b, 40) == 2.75);
  CHECK(at<double>(b, 48 + 5 * 8) == 6);
  CHECK(at<float>(b, 48 + 48 + 3 * 4) == -1e-4F);
  const std::size_t positions = 48 + 48 + 16;
  // The uint16 step over the longest side of the box is 300 / 65535 px; the maximum error is half a step.
  const double tolerance = 0.5 * 300 / 65535 + 1e-4;
  for (std::size_t i = 0; i < 11; ++i) {
    const double px = -50 + at<std::uint16_t>(b, positions + 4 * i) * 300.0 / 65535;
    const double py = -50 + at<std::uint16_t>(b, positions + 4 * i + 2) * 200.0 / 65535;
    CHECK(std::fabs(px - (99.5 + double(s.x[i]) / 2e-6)) < tolerance);
    CHECK(std::fabs(py - (49.5 - double(s.y[i]) / 2e-6)) < tolerance);
    const double turn = std::uint8_t(b[positions + 44 + i]) / 255.0 * 2 * std::acos(-1.0);
    CHECK(std::cos(turn - std::atan2(double(s.uy[i]), double(s.ux[i]))) >
          std::cos(0.5 / 255 * 2 * std::acos(-1.0)) - 1e-6);
    CHECK(((std::uint8_t(b[positions + 55 + i / 8]) >> (i % 8)) & 1) == (i % 3 ? 1 : 0));
  }
  CHECK(b.size() == positions + 44 + 11 + 2);
}

TEST_CASE("a box with 16-bit steps above 0.1 px is sent as floats") {
  CHECK(quantised({0, 0, 6553.5, 100}));
  CHECK_FALSE(quantised({0, 0, 6553.6, 100}));
  const Swarm s(5, 1e-3, 1e-3);
  FrameMessage m = message(s, {}, {});
  m.box = {-5000, -5000, 5000, 5000};
  m.field_columns = m.field_rows = 0;
  m.ux = m.uy = {};
  const std::string b = encode_frame(m);
  CHECK(at<std::uint16_t>(b, 6) == (1 | 2));
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(at<float>(b, 48 + 8 * i) == doctest::Approx(99.5 + double(s.x[i]) / 2e-6).epsilon(1e-6));
  CHECK(b.size() == 48 + 40 + 1);
}

TEST_CASE("the camera image is last") {
  const Swarm s(3, 1e-4, 1e-4);
  FrameMessage m = message(s, {}, {});
  m.field_columns = m.field_rows = 0;
  const std::vector<std::uint8_t> grey = {1, 2, 3, 4, 5, 6};
  m.picture = grey;
  m.picture_columns = 3;
  m.picture_rows = 2;
  const std::string b = encode_frame(m);
  CHECK((at<std::uint16_t>(b, 6) & 8) == 8);
  CHECK(at<std::uint16_t>(b, 20) == 3);
  CHECK(at<std::uint16_t>(b, 22) == 2);
  CHECK(b.substr(b.size() - 6) == std::string("\1\2\3\4\5\6"));
}

TEST_CASE("an occupancy grid has the site of every cell, and the number of cells in each square") {
  const Swarm s(500, 2.9e-4, 1.9e-4);
  const std::vector<double> rows = {1, 2, 3};
  const std::vector<float> field = {1e-4F, 0, 2e-4F, -1e-4F};
  FrameMessage m = message(s, rows, field);
  const std::vector<std::size_t> ends = {200, 500};
  m.ends = ends;
  std::vector<float> responsive = s.response;
  m.sites = 150;  // of a box of 300 x 200 px: 2 px each
  const std::string b = encode_frame(m);
  CHECK(at<std::uint16_t>(b, 6) == (1 | 16));
  CHECK(at<std::uint32_t>(b, 12) == 500);
  const int columns = at<std::uint16_t>(b, 28), grid_rows = at<std::uint16_t>(b, 30);
  REQUIRE(columns == 150);
  REQUIRE(grid_rows == 100);
  const std::size_t grid = 48 + 3 * 8 + 2 * 8, bytes = 150 * 100 / 8, planes = grid + 8;
  CHECK(at<std::uint16_t>(b, grid) == 4);
  CHECK(at<std::uint16_t>(b, grid + 6) == 0b1111);
  const int dc = at<std::uint16_t>(b, grid + 2), dr = at<std::uint16_t>(b, grid + 4);
  CHECK(dc == 64);
  CHECK(dr == 43);  // squares of 300 / 64 px
  REQUIRE(b.size() == planes + 4 * bytes + std::size_t(dc * dr) * 4);
  std::vector<std::string> expected(4, std::string(bytes, '\0'));
  for (std::size_t i = 0; i < 500; ++i) {
    const double x = 99.5 + double(s.x[i]) / 2e-6 + 50, y = 49.5 - double(s.y[i]) / 2e-6 + 50;
    const auto site = std::size_t(y / 2) * 150 + std::size_t(x / 2);
    char& byte = expected[(i < 200 ? 0U : 2U) + (s.response[i] != 0 ? 0U : 1U)][site / 8];
    byte = char(std::uint8_t(byte) | (1U << (site % 8)));
  }
  for (std::size_t p = 0; p < 4; ++p) CHECK(b.substr(planes + p * bytes, bytes) == expected[p]);
  std::uint32_t cells = 0;
  for (int k = 0; k < dc * dr; ++k) cells += at<std::uint32_t>(b, planes + 4 * bytes + std::size_t(k) * 4);
  CHECK(cells == 500);

  // A plane without cells is left out.
  std::fill(responsive.begin(), responsive.end(), 1.0F);
  m.response = responsive;
  const std::string all = encode_frame(m);
  CHECK(at<std::uint16_t>(all, grid + 6) == 0b0101);
  CHECK(all.size() == planes + 2 * bytes + std::size_t(dc * dr) * 4);
}

TEST_CASE("a frame message has the estimate and the plan at its end, if they are known") {
  const Swarm s(11, 2.9e-4, 1.9e-4);
  const std::vector<double> rows = {1, 2, 3};
  const std::vector<float> field = {1e-4F, 0, 2e-4F, -1e-4F};
  FrameMessage m = message(s, rows, field);
  const std::size_t plain = encode_frame(m).size();
  Estimate e;
  e.centroid = {20e-6, 10e-6};
  e.visible = 11;
  m.estimate = &e;
  CHECK(encode_frame(m).size() == plain);  // the error is not known
  e.centroid_cov = {4e-12, 1e-12, 8e-12};
  e.predicted = true;
  const std::vector<Vec2> path_m = {{0, 0}, {20e-6, -40e-6}};
  m.path = path_m;
  m.path_step = 0.25;
  m.limits = 2 | 64;
  const std::string b = encode_frame(m);
  CHECK(at<std::uint16_t>(b, 6) == (1 | 4 | 32 | 64));
  REQUIRE(b.size() == plain + 24 + 8 + 16);
  CHECK(at<std::uint32_t>(b, plain) == 1);
  const float estimate[] = {109.5F, 44.5F, 1.0F, -0.25F, 2.0F};  // px and px^2 of 2 um, y down
  for (std::size_t k = 0; k < 5; ++k) CHECK(at<float>(b, plain + 4 + 4 * k) == doctest::Approx(estimate[k]));
  CHECK(at<std::uint16_t>(b, plain + 24) == 2);
  CHECK(at<std::uint16_t>(b, plain + 26) == (2 | 64));
  CHECK(at<float>(b, plain + 28) == 0.25F);
  const float path[] = {99.5F, 49.5F, 109.5F, 69.5F};
  for (std::size_t k = 0; k < 4; ++k) CHECK(at<float>(b, plain + 32 + 4 * k) == doctest::Approx(path[k]));

  e.visible = 0;
  m.path = {};
  CHECK(encode_frame(m).size() == plain);
}
