#include "field/field_columns.h"

#include <algorithm>
#include <cctype>

namespace faba {
namespace {

struct NamedUnit {
  const char* name;
  FieldUnit unit;
};
constexpr NamedUnit kUnits[] = {{"m", {false, 1}},       {"cm", {false, 1e-2}},    {"mm", {false, 1e-3}},
                                {"um", {false, 1e-6}},   {"in", {false, 25.4e-3}}, {"inch", {false, 25.4e-3}},
                                {"t", {true, 1}},        {"mt", {true, 1e-3}},     {"ut", {true, 1e-6}},
                                {"nt", {true, 1e-9}},    {"g", {true, 1e-4}},      {"gs", {true, 1e-4}},
                                {"gauss", {true, 1e-4}}, {"mg", {true, 1e-7}},     {"kg", {true, 1e-1}},
                                {"tesla", {true, 1}},    {"metre", {false, 1}},    {"meter", {false, 1}}};

struct Quantity {
  const char* header;
  const char* name;
};
constexpr Quantity kQuantities[] = {{"x", "x"},       {"y", "y"},     {"z", "z"},   {"rho", "rho"},
                                    {"r", "rho"},     {"bx", "bx"},   {"by", "by"}, {"bz", "bz"},
                                    {"brho", "brho"}, {"br", "brho"}, {"b", "b"}};

// In lower case, with "u" for the micro sign in UTF-8 (both of its characters) and Latin-1.
std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool two = (c == 0xC2 || c == 0xCE) && i + 1 < text.size();
    if (two && (static_cast<unsigned char>(text[i + 1]) == 0xB5 ||
                static_cast<unsigned char>(text[i + 1]) == 0xBC)) {
      out += 'u';
      ++i;
    } else {
      out += c == 0xB5 ? 'u' : char(std::tolower(c));
    }
  }
  return out;
}

// Without separators and brackets.
std::string compact(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::string_view(" _-/,()[]\"'").find(c) == std::string_view::npos) out += c;
  return out;
}

}  // namespace

std::optional<FieldUnit> field_unit(std::string_view text) {
  const std::string name = compact(plain(text));
  for (const NamedUnit& u : kUnits)
    if (name == u.name || name == std::string("in") + u.name) return u.unit;  // "z in mm"
  return std::nullopt;
}

std::optional<FieldColumn> field_column(std::string_view header) {
  const std::string text = plain(header);
  const auto known = [](const std::string& name) {
    return std::find_if(std::begin(kQuantities), std::end(kQuantities),
                        [&](const Quantity& q) { return name == q.header; });
  };
  std::size_t end = text.find_first_of("([/ ,");
  // "bz_mt" is divided at its last underscore, "b_z" is not.
  if (end == std::string::npos && known(compact(text)) == std::end(kQuantities)) end = text.rfind('_');
  const Quantity* q = known(compact(std::string_view(text).substr(0, end)));
  if (q == std::end(kQuantities)) return std::nullopt;
  FieldColumn c{.quantity = q->name, .unit_text = {}, .unit = {}};
  if (end != std::string::npos) c.unit_text = compact(std::string_view(text).substr(end));
  c.unit = field_unit(c.unit_text);
  if (c.unit && c.unit->of_field != c.is_field()) c.unit.reset();
  return c;
}

}  // namespace faba
