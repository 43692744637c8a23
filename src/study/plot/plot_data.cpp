#include "study/plot/plot_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace faba::drawing {
namespace {

constexpr std::size_t kShortColumn = 100;
constexpr int kDigits = 6, kDigitsShort = 9;
constexpr double kLargest = 1e100,
                 kSmallest = 1e-100;  // a plot ignores larger values; smaller ones become zero
constexpr std::int64_t kMissing = std::numeric_limits<std::int64_t>::min();

// A signed integer in groups of five bits, lowest first; the lowest bit is the sign.
void append_code(std::string& codes, std::int64_t n) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint64_t rest = n < 0 ? std::uint64_t(-n) << 1 | 1 : std::uint64_t(n) << 1;
  do {
    const std::uint64_t group = rest & 31;
    rest >>= 5;
    codes += kLetters[group | (rest ? 32 : 0)];
  } while (rest);
}

std::string differences(const std::vector<std::int64_t>& numbers, int order) {
  std::string codes;
  std::int64_t last = 0, last_step = 0;
  for (const std::int64_t n : numbers) {
    if (n == kMissing) {
      codes += '-';
      continue;
    }
    const std::int64_t predicted = order == 0 ? 0 : order == 1 ? last : last + last_step;
    append_code(codes, n - predicted);
    last_step = n - last;
    last = n;
  }
  return codes;
}

std::string column(const std::string& offset, const std::string& step,
                   const std::vector<std::int64_t>& numbers) {
  int best = 0;
  std::string codes = differences(numbers, 0);
  for (const int order : {1, 2})
    if (std::string other = differences(numbers, order); other.size() < codes.size()) {
      codes = std::move(other);
      best = order;
    }
  return fmt::format("{} {} {} {}", offset, step, best, codes);
}

// The integers n of values n * 10^exponent. `exactly`: empty if a value is not such a multiple, to nine
// digits.
std::vector<std::int64_t> multiples(const std::vector<double>& values, int exponent, bool exactly) {
  std::vector<std::int64_t> numbers;
  for (const double v : values) {
    if (!(std::abs(v) < kLargest)) {
      numbers.push_back(kMissing);
      continue;
    }
    // A power of ten with a negative exponent is not exact: the division by its inverse is.
    const double n = exponent < 0 ? v * std::pow(10.0, -exponent) : v / std::pow(10.0, exponent);
    if (exactly && std::abs(n - std::round(n)) > 1e-9 * std::max(1.0, std::abs(n))) return {};
    numbers.push_back(std::llround(n));
  }
  return numbers;
}

struct Spacing {
  double first, step;
};
std::optional<Spacing> even_spacing(const std::vector<double>& all) {
  if (all.size() < 3) return {};
  const Spacing s{all.front(), (all.back() - all.front()) / double(all.size() - 1)};
  if (!std::isfinite(s.step) || s.step == 0) return {};
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!(std::abs(all[i] - (s.first + double(i) * s.step)) <= 1e-6 * std::abs(s.step))) return {};
  return s;
}

}  // namespace

std::string data_column(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values)
    if (std::abs(v) < kLargest) largest = std::max(largest, std::abs(v));
  if (largest < kSmallest) largest = 1;
  const int digits = values.size() <= kShortColumn ? kDigitsShort : kDigits;
  const int top = int(std::floor(std::log10(largest))) + 1;
  for (int exponent = std::max(top - 2, top - digits); exponent > top - digits; --exponent)
    if (const auto numbers = multiples(values, exponent, true); !numbers.empty())
      return column("0", fmt::format("1e{}", exponent), numbers);
  return column("0", fmt::format("1e{}", top - digits), multiples(values, top - digits, false));
}

std::string data_column(const std::vector<double>& all, const std::vector<int>& kept) {
  if (const auto even = even_spacing(all)) {
    const std::vector<std::int64_t> numbers = [&] {
      std::vector<std::int64_t> out;
      out.reserve(kept.size());
      for (const int i : kept) out.push_back(i < 0 ? kMissing : i);
      return out;
    }();
    return column(fmt::format("{}", even->first), fmt::format("{}", even->step), numbers);
  }
  std::vector<double> values;
  values.reserve(kept.size());
  for (const int i : kept)
    values.push_back(i < 0 ? std::numeric_limits<double>::quiet_NaN() : all[std::size_t(i)]);
  return data_column(values);
}

std::string data_attribute(const char* name, const std::string& column) {
  return fmt::format(R"( data-{}="{}")", name, column);
}

}  // namespace faba::drawing
