#include "vision/files/tiff/xml_attributes.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

namespace faba {
namespace {

constexpr auto kNone = std::string_view::npos;
constexpr std::string_view kSpaces = " \t\r\n";

// End of the markup that starts with `opening` at the front; the rest of the text if it is not closed.
std::optional<std::size_t> skipped(std::string_view xml, std::string_view opening, std::string_view closing) {
  if (!xml.starts_with(opening)) return std::nullopt;
  const std::size_t end = xml.find(closing, opening.size());
  return end == kNone ? xml.size() : end + closing.size();
}

// Length of a comment, CDATA section, processing instruction or document type at the front; 0: an element.
std::size_t other_markup(std::string_view xml) {
  using Pair = std::pair<std::string_view, std::string_view>;
  constexpr std::array<Pair, 3> kMarkup{{{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}};
  for (const auto& [opening, closing] : kMarkup)
    if (const auto length = skipped(xml, opening, closing)) return *length;
  if (!xml.starts_with("<!")) return 0;
  int depth = 0;  // a document type may contain declarations
  for (std::size_t at = 0; at < xml.size(); ++at) {
    if (xml[at] == '<') ++depth;
    if (xml[at] == '>' && --depth == 0) return at + 1;
  }
  return xml.size();
}

void append_utf8(std::uint32_t code, std::string& out) {
  const auto rest = [&](unsigned shift) { out += char(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) {
    out += char(code);
  } else if (code < 0x800) {
    out += char(0xC0U | (code >> 6U));
    rest(0);
  } else if (code < 0x10000) {
    out += char(0xE0U | (code >> 12U));
    rest(6);
    rest(0);
  }  // no unit or number is beyond the basic plane
}

// The character of a reference such as "lt" or "#xB5"; empty: not known.
std::string referenced(std::string_view name) {
  using Pair = std::pair<std::string_view, const char*>;
  constexpr std::array<Pair, 5> kNames{
      {{"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}}};
  for (const auto& [known, character] : kNames)
    if (name == known) return character;
  if (!name.starts_with('#')) return {};
  const bool hexadecimal = name.starts_with("#x");
  const std::string_view digits = name.substr(hexadecimal ? 2 : 1);
  std::uint32_t code = 0;
  const auto [end, failure] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
  std::string out;
  if (failure == std::errc() && end == digits.data() + digits.size()) append_utf8(code, out);
  return out;
}

std::string decoded(std::string_view value) {
  constexpr std::size_t kLongestReference = 8;
  std::string out;
  for (std::size_t at = 0; at < value.size(); ++at) {
    const std::size_t end = value[at] == '&' ? value.substr(at, kLongestReference).find(';') : kNone;
    const std::string character = end == kNone ? "" : referenced(value.substr(at + 1, end - 1));
    if (character.empty()) {
      out += value[at];
    } else {
      out += character;
      at += end;
    }
  }
  return out;
}

// Attributes from the text after the name of an element; empty unless the element is closed by `>`.
std::map<std::string, std::string> attributes_of(std::string_view xml) {
  std::map<std::string, std::string> found;
  for (std::size_t at = 0;;) {
    at = xml.find_first_not_of(kSpaces, at);
    if (at == kNone) return {};
    if (xml[at] == '>' || xml.substr(at).starts_with("/>")) return found;
    const std::size_t equals = xml.find('=', at);
    if (equals == kNone) return {};
    const std::size_t name_end = xml.find_last_not_of(kSpaces, equals - 1);
    const std::size_t open = xml.find_first_not_of(kSpaces, equals + 1);
    if (open == kNone || name_end == kNone || name_end < at || (xml[open] != '"' && xml[open] != '\''))
      return {};
    const std::size_t close = xml.find(xml[open], open + 1);
    if (close == kNone) return {};
    found.emplace(xml.substr(at, name_end + 1 - at), decoded(xml.substr(open + 1, close - open - 1)));
    at = close + 1;
  }
}

}  // namespace

std::map<std::string, std::string> xml_attributes(std::string_view xml, std::string_view element) {
  for (std::size_t at = xml.find('<'); at != kNone; at = xml.find('<', at)) {
    const std::string_view here = xml.substr(at);
    if (const std::size_t length = other_markup(here); length > 0) {
      at += length;
      continue;
    }
    const std::size_t end = here.find_first_of(" \t\r\n/>", 1);
    if (end == kNone) return {};
    std::string_view name = here.substr(1, end - 1);
    if (const std::size_t prefix = name.find(':'); prefix != kNone) name.remove_prefix(prefix + 1);
    if (name == element) return attributes_of(here.substr(end));
    at += end;
  }
  return {};
}

}  // namespace faba
