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

double number_of(const Json& asked, const char* key, double least, double most,
                 std::optional<double> fallback) {
  const bool given = asked.contains(key) && !asked[key].is_null();
  if (!given && fallback) return *fallback;
  if (!given || !asked[key].is_number()) throw Error(Errc::usage, key, "missing; it must be a number");
  const double value = asked[key];
  if (!(value >= least && value <= most))
    throw Error(Errc::usage, key,
                fmt::format("{:g} is out of range; it must be between {:g} and {:g}", value, least, most));
  return value;
}

std::uint64_t count_of(const Json& asked, const char* key, std::uint64_t least, std::uint64_t most,
                       std::optional<std::uint64_t> fallback) {
  const double value = number_of(asked, key, double(least), double(most),
                                 fallback ? std::optional(double(*fallback)) : std::nullopt);
  if (value != std::floor(value)) throw Error(Errc::usage, key, fmt::format("{:g} is not an integer", value));
  return std::uint64_t(value);
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
