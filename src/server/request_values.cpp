#include "server/request_values.h"

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

std::string file_name_of(const Json& asked) {
  constexpr std::size_t kLongest = 200;
  const std::string name = std::filesystem::path(asked.value("name", "")).filename().string();
  return name.empty() || name.size() > kLongest ? "file" : name;
}

}  // namespace faba
