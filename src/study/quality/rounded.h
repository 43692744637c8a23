#pragma once
#include <array>
#include <string>

namespace faba {

/// A value and its uncertainty as text, both rounded to the second significant digit of the uncertainty:
/// 13.2345 and 1.0871 become "13.2" and "1.1". Without a positive, finite uncertainty the value has three
/// significant digits, and `uncertainty` is empty.
struct Rounded {
  std::string value, uncertainty;
};
Rounded rounded(double value, double uncertainty);

/// "13.2 +- 1.1"; `plus_minus`: the sign between both, "±" on pages. Only the value without an uncertainty.
std::string with_uncertainty(double value, double uncertainty, const char* plus_minus = "+-");

/// A value and the ends of its interval, all rounded to the second significant digit of half the interval.
struct RoundedInterval {
  std::string value, low, high;
};
RoundedInterval rounded_interval(double value, const std::array<double, 2>& interval);

}  // namespace faba
