#include "study/quality/rounded.h"

#include <doctest/doctest.h>

#include <limits>

using namespace faba;

TEST_CASE("a value is rounded to the second significant digit of its uncertainty") {
  CHECK(with_uncertainty(13.2345, 1.0871) == "13.2 +- 1.1");
  CHECK(with_uncertainty(13.2345, 1.0871, "±") == "13.2 ± 1.1");
  CHECK(with_uncertainty(0.91642, 0.00412) == "0.9164 +- 0.0041");
  CHECK(with_uncertainty(13523, 1234) == "13500 +- 1200");
  CHECK(with_uncertainty(-4.0449, 0.998) == "-4.0 +- 1.0");  // the rounded uncertainty has two digits
  CHECK(with_uncertainty(3.12345e-9, 2.1e-11) == "3.123e-09 +- 2.1e-11");
  CHECK(with_uncertainty(0, 0.25) == "0.00 +- 0.25");
}

TEST_CASE("without an uncertainty a value has three significant digits") {
  for (const double none :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    CHECK(with_uncertainty(12.3456, none) == "12.3");
}

TEST_CASE("the ends of an interval are rounded as its middle") {
  const RoundedInterval r = rounded_interval(120.4567, {101.234, 133.97});
  CHECK(r.value == "120");
  CHECK(r.low == "101");
  CHECK(r.high == "134");
  const RoundedInterval narrow = rounded_interval(49.1234, {48.91, 49.36});
  CHECK(narrow.value == "49.12");
  CHECK(narrow.low == "48.91");
}
