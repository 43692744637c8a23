#include "server/shown/row_history.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

using namespace faba;

namespace {

// The first values of all rows after the rows 0 ... n - 1 were added.
std::vector<double> firsts(std::size_t n, std::size_t most) {
  RowHistory h(most);
  for (std::size_t i = 0; i < n; ++i) h.add(std::vector<double>{double(i), 10.0 * double(i)});
  std::vector<double> out;
  for (std::size_t k = 0; k < h.size(); ++k) {
    CHECK(h.row(k)[1] == 10 * h.row(k)[0]);
    out.push_back(h.row(k)[0]);
  }
  return out;
}

}  // namespace

TEST_CASE("a history keeps all rows until it is full, then thins its older half") {
  CHECK(firsts(8, 8) == std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(firsts(9, 8) == std::vector<double>{0, 2, 4, 5, 6, 7, 8});
  CHECK(firsts(11, 8) == std::vector<double>{0, 4, 6, 7, 8, 9, 10});
}

TEST_CASE("a long history is bounded, in order, and has the first and the newest rows") {
  const auto rows = firsts(100'000, 1200);
  CHECK(rows.size() <= 1200);
  CHECK(rows.front() == 0);
  CHECK(rows.back() == 99'999);
  for (std::size_t k = 1; k < rows.size(); ++k) REQUIRE(rows[k] > rows[k - 1]);
}
