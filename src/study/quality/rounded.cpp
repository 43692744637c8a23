#include "study/quality/rounded.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace faba {
namespace {

constexpr int kMostDecimals = 6;  // more are written with an exponent

// Writes numbers with the decimals that an uncertainty permits.
class Rounding {
 public:
  explicit Rounding(double uncertainty) {
    known_ = std::isfinite(uncertainty) && uncertainty > 0;
    if (!known_) return;
    const std::string two_digits = fmt::format("{:.1e}", uncertainty);
    decimals_ = 1 - std::stoi(two_digits.substr(two_digits.find('e') + 1));
  }
  bool known() const { return known_; }
  std::string text(double value) const {
    if (!known_ || !std::isfinite(value)) return fmt::format("{:.3g}", value);
    if (decimals_ > kMostDecimals) {
      const int exponent = value == 0 ? -decimals_ : int(std::floor(std::log10(std::fabs(value))));
      return fmt::format("{:.{}e}", value, std::max(0, exponent + decimals_));
    }
    if (decimals_ >= 0) return fmt::format("{:.{}f}", value, decimals_);
    const double unit = std::pow(10.0, -decimals_);
    return fmt::format("{:.0f}", std::round(value / unit) * unit);
  }

 private:
  bool known_ = false;
  int decimals_ = 0;
};

}  // namespace

Rounded rounded(double value, double uncertainty) {
  const Rounding rounding(uncertainty);
  return {rounding.text(value), rounding.known() ? rounding.text(uncertainty) : ""};
}

std::string with_uncertainty(double value, double uncertainty, const char* plus_minus) {
  const Rounded text = rounded(value, uncertainty);
  return text.uncertainty.empty() ? text.value
                                  : fmt::format("{} {} {}", text.value, plus_minus, text.uncertainty);
}

RoundedInterval rounded_interval(double value, const std::array<double, 2>& interval) {
  const Rounding rounding((interval[1] - interval[0]) / 2);
  return {rounding.text(value), rounding.text(interval[0]), rounding.text(interval[1])};
}

}  // namespace faba
