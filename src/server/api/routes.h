#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/web_handlers.h"

namespace faba {

/// The requests that the HTTP interface answers, each with its handler. Every file of this folder adds those
/// of one concept.
class Routes {
 public:
  /// `names`: the parts of the path that the pattern leaves open, in their order.
  using Handler = std::function<WebResponse(const WebRequest& r, const std::vector<std::string>& names)>;

  /// `pattern`: "/api/runs/*/frames"; `*` is one part of a path, `**` at the end is the rest of it, not
  /// empty. GET also answers HEAD.
  void add(std::string method, std::string_view pattern, Handler handler);
  /// Empty if no route fits. The first one that was added has precedence.
  std::optional<WebResponse> answer(const WebRequest& r) const;

 private:
  struct Route {
    std::string method;
    std::vector<std::string> pattern;
    Handler handler;
  };
  std::vector<Route> routes_;
};

}  // namespace faba
