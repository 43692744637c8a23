#include "rig/setup/amplifier.h"

#include <doctest/doctest.h>

#include <cmath>

#include "rig/setup/coil_calibration.h"

using namespace faba;

TEST_CASE("a current rises and falls exponentially with its own time constants") {
  Amplifier a(
      {.reference = 2.5, .gain = 0.2, .saturation = 1, .rise_time = 2e-3, .fall_time = 5e-3, .bits = 24}, 1);
  const double to = 0.2 * 1.5;
  a.take(std::vector<double>{4.0}, true, 1);
  CHECK(a.at(1)[0] == 0);
  CHECK(a.at(1.002)[0] == doctest::Approx(to * (1 - std::exp(-1))).epsilon(1e-6));
  a.take(std::vector<double>{2.5}, true, 1.03);
  CHECK(a.at(1.035)[0] == doctest::Approx(to * std::exp(-1)).epsilon(1e-5));
}

TEST_CASE("a change of sign uses the fall time down to zero, then the rise time") {
  Amplifier a({.gain = 1, .saturation = 1, .rise_time = 1e-3, .fall_time = 4e-3, .bits = 24}, 1);
  a.take(std::vector<double>{3.5}, true, 0);
  a.take(std::vector<double>{1.5}, true, 0.03);
  CHECK(a.at(0.03 + 4e-3 * std::log(2))[0] == doctest::Approx(0).epsilon(1e-6));
  const double after = a.at(0.03 + 4e-3 * std::log(2) + 1e-3)[0];
  CHECK(after == doctest::Approx(-(1 - std::exp(-1))).epsilon(1e-5));
}

TEST_CASE("12 bits, saturation, and a relay that opens when its enable line times out") {
  const Amplifier::Params p{.gain = 0.2, .saturation = 0.45, .bits = 12, .enable_time = 0.05};
  Amplifier a(p, 2);
  a.take(std::vector<double>{5.0, 2.5}, true, 0);
  a.at(0.04);
  CHECK(a.at(0.045)[0] == doctest::Approx(0.45));
  // The nearest of 4096 levels to 2.5 V is half a level off.
  CHECK(std::fabs(a.at(0.045)[1]) == doctest::Approx(0.2 * 0.5 * 5 / 4095).epsilon(1e-3));
  CHECK(a.enabled());
  a.at(0.06);
  CHECK_FALSE(a.enabled());
  CHECK(std::fabs(a.at(0.06)[0]) < 0.45);
  CHECK(std::fabs(a.at(0.1)[0]) < 1e-3);
  // Without a relay the last voltage remains.
  Amplifier bare({.gain = 0.2, .saturation = 0.45, .enable_line = false}, 1);
  bare.take(std::vector<double>{5.0}, false, 0);
  CHECK(bare.at(3600)[0] == doctest::Approx(0.45));
}

TEST_CASE("simulated faults: stuck, open, weak") {
  using enum Amplifier::Fault;
  for (const auto& [fault, expected] : {std::pair{stuck, 0.2}, {open, 0.0}, {weak, 0.15}}) {
    Amplifier a(
        {.gain = 0.2, .saturation = 1, .bits = 24, .enable_time = 10, .fault = fault, .fault_after = 1}, 1);
    a.take(std::vector<double>{3.5}, true, 0);
    CHECK(a.at(0.9)[0] == doctest::Approx(0.2));
    a.at(1.1);
    a.take(std::vector<double>{4.0}, true, 1.1);
    CHECK(a.at(1.5)[0] == doctest::Approx(expected).epsilon(1e-4));
  }
}

TEST_CASE(
    "voltage and current of a coil are inverse functions, with gain and with table, for both polarities") {
  WiredCoil by_gain{.channel = "0", .gain = 0.2, .neutral = 2.5, .polarity = -1};
  WiredCoil by_table{.channel = "1", .table = {{0, -0.6}, {2.4, 0}, {3, 0.1}, {5, 0.5}}};
  WiredCoil falling{.channel = "2", .table = {{0, 0.5}, {5, -0.5}}};
  for (const WiredCoil& c : {by_gain, by_table, falling})
    for (const double i : {-0.4, -0.01, 0.0, 0.05, 0.3})
      CHECK(c.current(c.volts(i)) == doctest::Approx(i).epsilon(1e-12));
  CHECK(by_gain.volts(0.1) == doctest::Approx(2.0));
  CHECK(by_table.volts(0) == doctest::Approx(2.4));
  CHECK(by_table.reach() == doctest::Approx(0.5));
}

TEST_CASE("coils of one channel get the mean of their requests, with polarity") {
  WiredCoil a{.channel = "Dev1/ao0", .gain = 0.2, .neutral = 2.5}, b = a, c = a;
  b.polarity = -1;
  c.channel = "Dev1/ao1";
  const CoilWiring w({a, b, c});
  CHECK(w.channels() == std::vector<std::string>{"Dev1/ao0", "Dev1/ao1"});
  const double requested[] = {0.3, -0.1, 0.2};
  const std::vector<double> volts = w.volts(requested);
  CHECK(volts[0] == doctest::Approx(2.5 + 0.2 / 0.2));
  CHECK(volts[1] == doctest::Approx(3.5));
  const std::vector<double> flows = w.currents(volts);
  CHECK(flows[0] == doctest::Approx(0.2));
  CHECK(flows[1] == doctest::Approx(-0.2));
  CHECK(w.neutral() == std::vector<double>{2.5, 2.5});
  const double excessive[] = {9, -9, -9};
  CHECK(w.volts(excessive)[0] == 5);
  CHECK(w.volts(excessive)[1] == 0);
}
