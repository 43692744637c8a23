#include "core/units.h"

#include <doctest/doctest.h>

#include <stdexcept>

using namespace faba;

TEST_CASE("quantities are converted to the double nearest to their SI value") {
  CHECK(parse_quantity("186 um/s").value == 186e-6);
  CHECK(parse_quantity("1e-15 A m^2").value == 1e-15);
  CHECK(parse_quantity("23uT").value == 23e-6);
  CHECK(parse_quantity("0.8015 \u00b5m").value == doctest::Approx(0.8015e-6).epsilon(1e-15));
  CHECK(parse_quantity("2 min").value == 120);
  CHECK(parse_quantity("-3.5e2 mT").value == doctest::Approx(-0.35).epsilon(1e-15));
  CHECK(parse_quantity("7").value == 7);
  CHECK(parse_quantity("+7 kHz").value == 7000);
  CHECK(parse_quantity("180 deg").value == doctest::Approx(3.14159265358979).epsilon(1e-14));
  CHECK(parse_quantity("5 1/(T s)").value == 5);
  CHECK(parse_quantity("10 %").value == 0.1);
}

TEST_CASE("dimensions") {
  CHECK(parse_unit("N m s").dimension == parse_unit("kg m^2/s").dimension);
  CHECK(parse_unit("T").dimension == parse_unit("V s/m^2").dimension);
  CHECK(parse_unit("A m^2").dimension == parse_unit("J/T").dimension);
  CHECK_FALSE(parse_unit("m").dimension == parse_unit("px").dimension);
  CHECK(dimension_name(parse_unit("mm/min").dimension) == "speed");
  CHECK(dimension_name(parse_unit("mV").dimension) == "voltage");
  CHECK(dimension_name(parse_unit("mW").dimension) == "power");
  CHECK(dimension_name(parse_unit("mol/m^3").dimension) == "quantity in m^-3 mol");
}

TEST_CASE("invalid quantities are rejected") {
  for (const char* bad : {"", "um", "abc", "1 parsec", "1 m^", "1 m^99", "1 (m", "1 m/", "1 m)", "1e999 m",
                          "1 ((((((((((((m", "1 \xff\xfe", "0x10 m", "1 m^1.5"})
    CHECK_THROWS_AS(parse_quantity(bad), std::invalid_argument);
}

TEST_CASE("a printed number is read back unchanged") {
  for (const double v : {1.0 / 3, 186e-6, 23e-6, 1e-300, 6.02214076e23, 0.1})
    CHECK(parse_quantity(format_quantity(v, "m/s")).value == v);
}
