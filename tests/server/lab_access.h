#pragma once
#include <fmt/format.h>

#include <string>

#include "tests/server/raw_client.h"

namespace faba::test {

/// Address of a lab server, and requests to it.
struct LabAccess {
  unsigned short port = 0;
  std::string token;

  /// From the address that the lab prints; nothing changes if it is not one.
  void read_address(const std::string& address) {
    const std::string before = "http://127.0.0.1:", between = "/?token=";
    const std::size_t at = address.find(between);
    if (!address.starts_with(before) || at == std::string::npos) return;
    port = static_cast<unsigned short>(std::stoi(address.substr(before.size(), at - before.size())));
    token = address.substr(at + between.size());
  }
  /// Header lines of the lab's page, with the cookie.
  std::string own() const {
    return fmt::format(
        "Host: 127.0.0.1:{0}\r\nCookie: faba-{0}={1}\r\nOrigin: http://127.0.0.1:{0}\r\nSec-Fetch-Site: "
        "same-origin\r\n",
        port, token);
  }
  std::string ask(const std::string& line, const std::string& headers, const std::string& body = "") const {
    RawClient c(port);
    c.send(fmt::format("{} HTTP/1.1\r\n{}Content-Length: {}\r\n\r\n{}", line, headers, body.size(), body));
    return c.answer();
  }
  std::string get(const std::string& path) const { return ask("GET " + path, own()); }
};

}  // namespace faba::test
