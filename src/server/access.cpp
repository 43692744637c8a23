#include "server/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace faba {

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  unsigned differs = a.size() != b.size();
  for (std::size_t i = 0; i < a.size(); ++i)
    differs |= unsigned(std::uint8_t(a[i])) ^ unsigned(b.empty() ? 0 : std::uint8_t(b[i % b.size()]));
  return differs == 0;
}

std::string random_token() {
  std::random_device device;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", device());
  return token;
}

Access::Access(std::string token, unsigned short port)
    : token_(std::move(token)),
      cookie_name_(
          fmt::format("faba-{}", port)),  // cookies ignore ports; the name permits two labs at the same time
      hosts_({fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)}) {}

std::string Access::origin() const { return "http://" + hosts_.front(); }

std::string Access::cookie() const {
  return fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name_, token_);
}

bool Access::own_origin(std::string_view origin) const {
  return std::any_of(hosts_.begin(), hosts_.end(),
                     [&](const std::string& host) { return origin == "http://" + host; });
}

bool Access::has_valid_cookie(const Credentials& c) const {
  bool valid = false;
  for (std::string_view line : c.cookie)
    while (!line.empty()) {
      const auto end = std::min(line.find(';'), line.size());
      std::string_view one = line.substr(0, end);
      one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
      if (one.starts_with(cookie_name_ + "="))
        valid |= equal_in_constant_time(one.substr(cookie_name_.size() + 1), token_);
      line.remove_prefix(std::min(end + 1, line.size()));
    }
  return valid;
}

Access::Verdict Access::judge(const Credentials& c) const {
  const auto forbidden = [](const char* why) { return Verdict{403, why}; };
  if (c.host.size() != 1 || std::find(hosts_.begin(), hosts_.end(), c.host.front()) == hosts_.end())
    return forbidden("forbidden: Host must be 127.0.0.1 or localhost with the port of this server");
  if (c.origin.size() > 1 || (!c.origin.empty() && !own_origin(c.origin.front())))
    return forbidden("forbidden: request from another origin");
  // Requests from other sites: a token in the URL is accepted, the cookie is not.
  const bool other_site = std::any_of(c.fetch_site.begin(), c.fetch_site.end(), [](const std::string& s) {
    return s == "cross-site" || s == "same-site";  // another port of this machine is "same-site"
  });

  bool by_token = !c.query_token.empty() && equal_in_constant_time(c.query_token, token_);
  for (const std::string& a : c.authorization)
    by_token |= a.starts_with("Bearer ") && equal_in_constant_time(std::string_view(a).substr(7), token_);
  const bool by_cookie = !other_site && has_valid_cookie(c);
  if (!by_token && !by_cookie)
    return {401, "unauthorized: open the URL printed by `faba lab`, with its token"};

  if (c.upgrade && c.origin.empty()) return forbidden("forbidden: WebSocket request without Origin header");
  const bool reads = c.method == "GET" || c.method == "HEAD";
  if (!reads) {
    if (!by_token && c.origin.empty()) return forbidden("forbidden: missing Origin header");
    if (!c.content_type.starts_with("application/json") &&
        !c.content_type.starts_with("application/octet-stream"))
      return {415, "unsupported media type: send application/json"};  // HTML forms of other sites cannot send
                                                                      // these types
  }
  return {200, "", by_token};
}

}  // namespace faba
