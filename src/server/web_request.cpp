#include "server/web_request.h"

#include <algorithm>
#include <charconv>

namespace faba {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// "a%20b" -> "a b"; empty for invalid escapes and control characters.
std::optional<std::string> decoded(std::string_view s, bool plus_is_space) {
  std::string out;
  for (std::size_t i = 0; i < s.size(); ++i) {
    char c = s[i];
    if (c == '%') {
      if (i + 2 >= s.size()) return {};
      const int high = hex_digit(s[i + 1]), low = hex_digit(s[i + 2]);
      if (high < 0 || low < 0) return {};
      c = char(high * 16 + low);
      i += 2;
    } else if (c == '+' && plus_is_space) {
      c = ' ';
    }
    if (std::uint8_t(c) < 0x20 || c == 0x7f) return {};
    out += c;
  }
  return out;
}

bool is_unsafe(std::string_view path) {
  if (!path.starts_with('/') || path.find('\\') != std::string_view::npos) return true;
  for (std::size_t at = 1; at < path.size();) {
    const auto end = std::min(path.find('/', at), path.size());
    const std::string_view part = path.substr(at, end - at);
    if (part.empty() || part == "." || part == "..") return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

std::optional<WebTarget> parse_target(std::string_view target) {
  constexpr std::size_t kMost = 8192;
  if (target.size() > kMost) return {};
  const auto question = target.find('?');
  const auto path = decoded(target.substr(0, question), false);
  if (!path || is_unsafe(*path)) return {};
  WebTarget t;
  t.path = *path;
  if (question == std::string_view::npos) return t;
  for (std::string_view rest = target.substr(question + 1); !rest.empty();) {
    const auto end = std::min(rest.find('&'), rest.size());
    const std::string_view pair = rest.substr(0, end);
    const auto equals = std::min(pair.find('='), pair.size());
    const auto key = decoded(pair.substr(0, equals), true);
    const auto value = decoded(pair.substr(std::min(equals + 1, pair.size())), true);
    if (!key || !value) return {};
    if (!key->empty()) t.query[*key] = *value;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return t;
}

std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit) || size == 0) return {};
  header.remove_prefix(kUnit.size());
  const auto dash = header.find('-');
  if (dash == std::string_view::npos) return {};
  const auto number = [](std::string_view s) -> std::optional<std::uint64_t> {
    std::uint64_t v = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), v);
    if (error != std::errc() || end != s.data() + s.size()) return {};
    return v;
  };
  const std::string_view first = header.substr(0, dash), last = header.substr(dash + 1);
  const auto from = number(first), to = number(last);
  if (first.empty()) {  // suffix range
    if (!to || *to == 0) return {};
    return ByteRange{size - std::min(*to, size), size};
  }
  if (!from || *from >= size || (!last.empty() && (!to || *to < *from))) return {};
  return ByteRange{*from, last.empty() ? size : std::min(*to + 1, size)};
}

}  // namespace faba
