#include "server/request_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/error.h"

namespace faba {

Json body_of(const WebRequest& r) {
  Json j = Json::parse(r.body, nullptr, false);
  if (!j.is_object()) throw Error(Errc::usage, "invalid request", "not a JSON object");
  return j;
}

std::string text_of(const Json& asked, const char* key) {
  if (!asked.contains(key) || !asked[key].is_string() || asked[key].get<std::string>().empty())
    throw Error(Errc::usage, key, "missing; it must be a non-empty string");
  return asked[key];
}

std::string numbers_of(const Json& asked, const char* key) {
  std::string list = text_of(asked, key);
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    const std::string one = list.substr(at, comma - at);
    char* end = nullptr;
    const double value = std::strtod(one.c_str(), &end);
    const bool complete =
        end != one.c_str() && one.find_first_not_of(' ', std::size_t(end - one.c_str())) == one.npos;
    if (!complete || !std::isfinite(value))
      throw Error(
          Errc::usage, key,
          fmt::format("\"{}\" is not a number; it must be numbers separated by commas, such as 0.5, 0", one));
    at = comma + 1;
  }
  return list;
}

std::string file_name_of(const Json& asked) {
  constexpr std::size_t kLongest = 200;
  const std::string name = std::filesystem::path(asked.value("name", "")).filename().string();
  return name.empty() || name.size() > kLongest ? "file" : name;
}

}  // namespace faba
