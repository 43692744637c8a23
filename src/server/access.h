#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Headers of a request that prove its origin. The server converts header names to lower case; a repeated
/// header has several values.
struct Credentials {
  std::string method;
  std::vector<std::string> host, origin, cookie, authorization, fetch_site;
  std::string content_type;
  std::string query_token;  ///< value of ?token=
  bool upgrade = false;     ///< request for a WebSocket
};

/// Access control: only pages served by this lab, on this machine, to a user with the token. Any web page can
/// make a browser send requests to this server, so the token is not sufficient: Host and Origin must be those
/// of the lab, including the port (no exception for numeric addresses, the mistake of CVE-2025-30360).
class Access {
 public:
  /// `token`: at least 128 random bits as text.
  Access(std::string token, unsigned short port);

  struct Verdict {
    int status = 200;       ///< or 401, 403, 415
    std::string why;        ///< message for the page
    bool by_token = false;  ///< authorised by the token, to be exchanged for the cookie
  };
  Verdict judge(const Credentials& c) const;
  /// Value of Set-Cookie, which replaces the token in later requests.
  std::string cookie() const;
  const std::string& token() const { return token_; }
  /// "http://127.0.0.1:PORT".
  std::string origin() const;

 private:
  bool own_origin(std::string_view origin) const;
  bool has_valid_cookie(const Credentials& c) const;

  std::string token_;
  std::string cookie_name_;
  std::vector<std::string> hosts_;  ///< "127.0.0.1:PORT", "localhost:PORT"
};

/// Comparison in constant time.
bool equal_in_constant_time(std::string_view a, std::string_view b);
/// 32 random hexadecimal digits from the random device of the system.
std::string random_token();

}  // namespace faba
