#include "server/request_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/error.h"
#include "core/json_input.h"

namespace faba {

Json body_of(const WebRequest& r) {
  Json j = parse_json(r.body);
  if (!j.is_object())
    throw Error(Errc::usage, "invalid request", "not a JSON object, or its nesting is too deep");
  return j;
}

std::string query_text(const WebRequest& r, const char* key) {
  const auto it = r.query.find(key);
  return it == r.query.end() ? "" : it->second;
}

double query_number(const WebRequest& r, const char* key, double fallback) {
  const std::string given = query_text(r, key);
  if (given.empty()) return fallback;
  char* end = nullptr;
  const double value = std::strtod(given.c_str(), &end);
  if (*end != 0 || !std::isfinite(value))
    throw Error(Errc::usage, key, fmt::format("\"{}\" is not a number; it must be a finite number", given));
  return value;
}

std::uint64_t query_count(const WebRequest& r, const char* key, std::uint64_t fallback) {
  const std::string given = query_text(r, key);
  if (given.empty()) return fallback;
  std::uint64_t n = 0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), n);
  if (error != std::errc() || end != given.data() + given.size())
    throw Error(Errc::usage, key, fmt::format("\"{}\" must be an integer from 0", given));
  return n;
}

std::string text_of(const Json& asked, const char* key) {
  if (!asked.contains(key) || !asked[key].is_string() || asked[key].get<std::string>().empty())
    throw Error(Errc::usage, key, "missing; it must be a non-empty string");
  return asked[key];
}

std::string file_name_of(const Json& asked) {
  constexpr std::size_t kLongest = 200;
  const std::string name = std::filesystem::path(asked.value("name", "")).filename().string();
  return name.empty() || name.size() > kLongest ? "file" : name;
}

}  // namespace faba
