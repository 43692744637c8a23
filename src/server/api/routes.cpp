#include "server/api/routes.h"

namespace faba {
namespace {

constexpr std::string_view kOne = "*", kRest = "**";

std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t at = 1; at <= path.size();) {
    const auto end = std::min(path.find('/', at), path.size());
    parts.emplace_back(path.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::size_t from) {
  std::string text = parts[from];
  for (std::size_t i = from + 1; i < parts.size(); ++i) text += "/" + parts[i];
  return text;
}

// The open parts of a path; empty if the path does not fit.
std::optional<std::vector<std::string>> match(const std::vector<std::string>& pattern,
                                              const std::vector<std::string>& path) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (i >= path.size()) return {};
    if (pattern[i] == kRest) {
      names.push_back(joined(path, i));
      return names;
    }
    if (pattern[i] == kOne)
      names.push_back(path[i]);
    else if (pattern[i] != path[i])
      return {};
  }
  if (path.size() != pattern.size()) return {};
  return names;
}

}  // namespace

void Routes::add(std::string method, std::string_view pattern, Handler handler) {
  routes_.push_back({std::move(method), parts_of(pattern), std::move(handler)});
}

std::optional<WebResponse> Routes::answer(const WebRequest& r) const {
  const std::vector<std::string> path = parts_of(r.path);
  const std::string& method = r.method == "HEAD" ? "GET" : r.method;
  for (const Route& route : routes_) {
    if (route.method != method) continue;
    if (const auto names = match(route.pattern, path)) return route.handler(r, *names);
  }
  return {};
}

}  // namespace faba
