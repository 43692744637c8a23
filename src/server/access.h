#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// What a request says of where it comes from. Names of headers are folded to lower case by the server; a
/// header that was sent more than once has several values.
struct Credentials {
  std::string method;
  std::vector<std::string> host, origin, cookie, authorization, fetch_site;
  std::string content_type;
  std::string query_token;  ///< of ?token=
  bool upgrade = false;     ///< asks for a WebSocket
};

/// Who may talk to the lab: pages that it served itself to somebody who knows its token, on this machine.
/// Any page of the web can make a browser send requests here, so the token alone is not trusted to come from
/// the user: host and origin must be the lab's own, with its port (no exception for addresses in numbers, the
/// mistake of CVE-2025-30360).
class Access {
 public:
  /// `token`: at least 128 random bits as text.
  Access(std::string token, unsigned short port);

  struct Verdict {
    int status = 200;       ///< or 401, 403, 415
    std::string why;        ///< for the page
    bool by_token = false;  ///< with the token itself, which is to be exchanged for the cookie
  };
  Verdict judge(const Credentials& c) const;
  /// Set-Cookie that stands for the token from then on.
  std::string cookie() const;
  const std::string& token() const { return token_; }
  /// "http://127.0.0.1:PORT".
  std::string origin() const;

 private:
  bool ours(std::string_view origin) const;
  bool knows_cookie(const Credentials& c) const;

  std::string token_;
  std::string cookie_name_;
  std::vector<std::string> hosts_;  ///< "127.0.0.1:PORT", "localhost:PORT"
};

/// Compares in a time that does not depend on where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);
/// 32 hexadecimal digits from the system's source of randomness.
std::string random_token();

}  // namespace faba
