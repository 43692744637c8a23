#include "core/units.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "core/portable.h"

namespace faba {
namespace {

// The factor of a unit is factor * 10^ten: with a separate decimal power "186 um" gives the same double as
// 1.86e-4.
struct Factor {
  double factor = 1;
  int ten = 0;
  Dimension dim;
};

struct Named {
  std::string_view name;
  Factor f;
};
constexpr Dimension dim(int m, int kg, int s, int a, int k = 0, int mol = 0, int px = 0) {
  return {{std::int8_t(m), std::int8_t(kg), std::int8_t(s), std::int8_t(a), std::int8_t(k), std::int8_t(mol),
           std::int8_t(px)}};
}
constexpr Named kUnits[] = {
    {"m", {1, 0, dim(1, 0, 0, 0)}},
    {"g", {1, -3, dim(0, 1, 0, 0)}},
    {"s", {1, 0, dim(0, 0, 1, 0)}},
    {"A", {1, 0, dim(0, 0, 0, 1)}},
    {"K", {1, 0, dim(0, 0, 0, 0, 1)}},
    {"mol", {1, 0, dim(0, 0, 0, 0, 0, 1)}},
    {"px", {1, 0, dim(0, 0, 0, 0, 0, 0, 1)}},
    {"rad", {1, 0, {}}},
    {"deg", {kDegree, 0, {}}},
    {"%", {1, -2, {}}},
    {"Hz", {1, 0, dim(0, 0, -1, 0)}},
    {"min", {60, 0, dim(0, 0, 1, 0)}},
    {"h", {3600, 0, dim(0, 0, 1, 0)}},
    {"T", {1, 0, dim(0, 1, -2, -1)}},
    {"G", {1, -4, dim(0, 1, -2, -1)}},
    {"N", {1, 0, dim(1, 1, -2, 0)}},
    {"J", {1, 0, dim(2, 1, -2, 0)}},
    {"W", {1, 0, dim(2, 1, -3, 0)}},
    {"Pa", {1, 0, dim(-1, 1, -2, 0)}},
    {"V", {1, 0, dim(2, 1, -3, -1)}},
    {"ohm", {1, 0, dim(2, 1, -3, -2)}},
    {"H", {1, 0, dim(2, 1, -2, -2)}},
    {"1", {1, 0, {}}},
};
struct Prefix {
  std::string_view text;
  int ten;
};
constexpr Prefix kPrefixes[] = {{"f", -15}, {"p", -12}, {"n", -9}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6},
                                {"m", -3},  {"c", -2},  {"k", 3},  {"M", 6},  {"G", 9}};

const Factor* find_unit(std::string_view name) {
  for (const auto& u : kUnits)
    if (u.name == name) return &u.f;
  return nullptr;
}

Factor named_unit(std::string_view name) {
  if (const Factor* f = find_unit(name)) return *f;
  for (const auto& p : kPrefixes)
    if (name.size() > p.text.size() && name.starts_with(p.text))
      if (const Factor* f = find_unit(name.substr(p.text.size())); f && name.substr(p.text.size()) != "1") {
        Factor scaled = *f;
        scaled.ten += p.ten;
        return scaled;
      }
  for (const std::string_view celsius : {"degC", "C", "\u00b0C", "\u2103"})
    if (name == celsius)
      throw std::invalid_argument(
          fmt::format("unknown unit \"{}\"; write a temperature in kelvin: 20 degC is \"293.15 K\"", name));
  throw std::invalid_argument(fmt::format("unknown unit \"{}\"", name));
}

// A product, because std::pow differs in the last bit between processors.
double integer_power(double x, int n) {
  double product = 1;
  for (int i = 0; i < std::abs(n); ++i) product *= x;
  return n < 0 ? 1 / product : product;
}

Factor power(const Factor& f, int n) {
  Factor r{integer_power(f.factor, n), f.ten * n, {}};
  for (std::size_t i = 0; i < r.dim.exponent.size(); ++i)
    r.dim.exponent[i] = std::int8_t(f.dim.exponent[i] * n);
  return r;
}
Factor product(const Factor& a, const Factor& b) {
  Factor r{a.factor * b.factor, a.ten + b.ten, {}};
  for (std::size_t i = 0; i < r.dim.exponent.size(); ++i)
    r.dim.exponent[i] = std::int8_t(a.dim.exponent[i] + b.dim.exponent[i]);
  return r;
}

// unit := factor { ('*' | '/' | blank) factor };  factor := '(' unit ')' | name, then optionally ^integer
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}
  Factor complete_unit() {
    const Factor f = unit(0);
    if (at_ < text_.size()) throw std::invalid_argument(fmt::format("cannot read the unit \"{}\"", text_));
    return f;
  }

 private:
  void blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  Factor unit(int depth) {
    Factor f = factor(depth);
    for (blanks(); at_ < text_.size() && text_[at_] != ')'; blanks()) {
      const char op = text_[at_];
      if (op == '*' || op == '/') ++at_;
      f = product(f, power(factor(depth), op == '/' ? -1 : 1));
    }
    return f;
  }
  Factor factor(int depth) {
    blanks();
    if (depth > 8) throw std::invalid_argument("too many parentheses in a unit");
    Factor f;
    if (at_ < text_.size() && text_[at_] == '(') {
      ++at_;
      f = unit(depth + 1);
      if (at_ >= text_.size())
        throw std::invalid_argument(fmt::format("missing ) in the unit \"{}\"", text_));
      ++at_;
    } else {
      const std::size_t end = std::min(text_.find_first_of(" */^()", at_), text_.size());
      f = named_unit(text_.substr(at_, end - at_));
      at_ = end;
    }
    if (at_ < text_.size() && text_[at_] == '^') {
      int n = 0;
      const auto [p, e] = std::from_chars(text_.data() + at_ + 1, text_.data() + text_.size(), n);
      if (e != std::errc{} || n < -9 || n > 9)
        throw std::invalid_argument(fmt::format("cannot read the power in the unit \"{}\"", text_));
      at_ = std::size_t(p - text_.data());
      f = power(f, n);
    }
    return f;
  }
  std::string_view text_;
  std::size_t at_ = 0;
};

// 10^n is exact up to n = 22, so there is only one rounding.
double times_ten(double v, int n) {
  for (; n > 22; n -= 22) v *= 1e22;
  for (; n < -22; n += 22) v /= 1e22;
  double p = 1;
  for (int i = 0; i < std::abs(n); ++i) p *= 10;
  return n < 0 ? v / p : v * p;
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
  return s;
}

}  // namespace

Quantity parse_unit(std::string_view unit) {
  unit = trimmed(unit);
  if (unit.empty()) return {1, {}};
  const Factor f = UnitParser(unit).complete_unit();
  return {times_ten(f.factor, f.ten), f.dim};
}

Quantity parse_quantity(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double v = 0;
  const auto [p, e] = portable::from_chars(text.data(), text.data() + text.size(), v);
  if (e == std::errc::result_out_of_range)
    throw std::invalid_argument(fmt::format("the number in \"{}\" is too large or too small", text));
  if (e != std::errc{}) throw std::invalid_argument(fmt::format("\"{}\" does not start with a number", text));
  const std::string_view rest = trimmed(text.substr(std::size_t(p - text.data())));
  if (rest.empty()) return {v, {}, true};
  const Factor f = UnitParser(rest).complete_unit();
  return {times_ten(v * f.factor, f.ten), f.dim};
}

std::string dimension_name(const Dimension& d) {
  static constexpr std::pair<const char*, const char*> kNames[] = {{"", "number without a unit"},
                                                                   {"m", "length"},
                                                                   {"s", "time"},
                                                                   {"Hz", "rate"},
                                                                   {"m/s", "speed"},
                                                                   {"T", "magnetic field"},
                                                                   {"A", "current"},
                                                                   {"T/A", "field per current"},
                                                                   {"A m^2", "magnetic moment"},
                                                                   {"px", "number of pixels"},
                                                                   {"K", "temperature"},
                                                                   {"V", "voltage"},
                                                                   {"ohm", "resistance"},
                                                                   {"W", "power"},
                                                                   {"Pa s", "viscosity"},
                                                                   {"m^2/s", "diffusivity"},
                                                                   {"N m s", "rotational drag"},
                                                                   {"A/s", "current slew rate"}};
  for (const auto& [unit, name] : kNames)
    if (parse_unit(unit).dimension == d) return name;
  static constexpr const char* kBase[] = {"m", "kg", "s", "A", "K", "mol", "px"};
  std::string s;
  for (std::size_t i = 0; i < d.exponent.size(); ++i)
    if (d.exponent[i]) {
      s += fmt::format("{}{}", s.empty() ? "" : " ", kBase[i]);
      if (d.exponent[i] != 1) s += fmt::format("^{}", int(d.exponent[i]));
    }
  return "quantity in " + s;
}

std::string format_quantity(double in_si, std::string_view unit) {
  return unit.empty() ? fmt::format("{}", in_si) : fmt::format("{} {}", in_si, unit);
}

}  // namespace faba
