#include "server/access.h"

#include <doctest/doctest.h>

using namespace faba;

namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";
const Access kAccess(kToken, 8123);

/// A request of the lab's page, with the cookie.
Credentials own(const char* method = "GET") {
  Credentials c;
  c.method = method;
  c.host = {"127.0.0.1:8123"};
  c.cookie = {"other=1; faba-8123=" + kToken};
  c.fetch_site = {"same-origin"};
  if (std::string(method) != "GET") {
    c.origin = {"http://127.0.0.1:8123"};
    c.content_type = "application/json";
  }
  return c;
}
int status(const Credentials& c) { return kAccess.judge(c).status; }

}  // namespace

TEST_CASE("requests of the lab's page are accepted") {
  CHECK(status(own()) == 200);
  CHECK(status(own("POST")) == 200);
  Credentials c = own();
  c.cookie.clear();
  c.query_token = kToken;
  CHECK(status(c) == 200);
  CHECK(kAccess.judge(c).by_token);
  c.query_token.clear();
  c.authorization = {"Bearer " + kToken};
  CHECK(status(c) == 200);
  c = own();
  c.host = {"localhost:8123"};
  CHECK(status(c) == 200);
}

TEST_CASE("S2: requests without a valid token are refused") {
  Credentials c = own();
  c.cookie.clear();
  CHECK(status(c) == 401);
  c.upgrade = true;
  c.origin = {"http://127.0.0.1:8123"};
  CHECK(status(c) == 401);
  for (const std::string& wrong : {kToken.substr(1), kToken + "0", "f" + kToken.substr(1), std::string()}) {
    c = own();
    c.cookie = {"faba-8123=" + wrong};
    CHECK(status(c) == 401);
    c.cookie.clear();
    c.query_token = wrong;
    CHECK(status(c) == 401);
    c.query_token.clear();
    c.authorization = {"Bearer " + wrong};
    CHECK(status(c) == 401);
  }
  c = own();
  c.cookie = {"faba-8124=" + kToken};  // cookie of a lab on another port
  CHECK(status(c) == 401);
}

TEST_CASE("S3: wrong, missing and repeated Host headers are refused") {
  for (const char* host : {"evil.example", "evil.example:8123", "127.0.0.1.evil.example:8123", "127.0.0.1",
                           "127.0.0.1:80", "localhost", "[::1]:8123", "0.0.0.0:8123", ""}) {
    Credentials c = own();
    c.host = {host};
    INFO(host);
    CHECK(status(c) == 403);
  }
  Credentials c = own();
  c.host.clear();
  CHECK(status(c) == 403);
  c.host = {"127.0.0.1:8123", "127.0.0.1:8123"};
  CHECK(status(c) == 403);
}

TEST_CASE("S4: WebSockets need the lab's origin (CVE-2025-30360: also for numeric addresses)") {
  Credentials c = own();
  c.upgrade = true;
  CHECK(status(c) == 403);  // no Origin header
  for (const char* origin : {"http://127.0.0.1:8124", "http://127.0.0.1", "https://127.0.0.1:8123", "null",
                             "http://1.2.3.4", "http://1.2.3.4:8123", "file://",
                             "http://127.0.0.1:8123.evil.example", "http://127.0.0.1:81234", ""}) {
    c.origin = {origin};
    INFO(origin);
    CHECK(status(c) == 403);
  }
  c.origin = {"http://127.0.0.1:8123", "http://1.2.3.4"};
  CHECK(status(c) == 403);
  c.origin = {"http://127.0.0.1:8123"};
  CHECK(status(c) == 200);
}

TEST_CASE("S5: content types of HTML forms are refused") {
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
    Credentials c = own("POST");
    c.content_type = type;
    INFO(type);
    CHECK(status(c) == 415);
  }
  Credentials c = own("POST");
  c.origin.clear();  // browsers always send it
  CHECK(status(c) == 403);
  c = own("DELETE");
  c.origin = {"http://127.0.0.1:9999"};
  CHECK(status(c) == 403);
}

TEST_CASE("the cookie is refused in requests of pages on another port, which are same-site") {
  for (const char* site : {"same-site", "cross-site"}) {
    Credentials c = own();
    c.fetch_site = {site};
    CHECK(status(c) == 401);
  }
}

TEST_CASE("S8: tokens are random and long, and the cookie is not accessible to scripts") {
  CHECK(random_token() != random_token());
  CHECK(random_token().size() == 32);
  CHECK(kAccess.cookie().find("HttpOnly") != std::string::npos);
  CHECK(kAccess.cookie().find("SameSite=Strict") != std::string::npos);
  CHECK(equal_in_constant_time(kToken, kToken));
  CHECK_FALSE(equal_in_constant_time(kToken, ""));
  CHECK_FALSE(equal_in_constant_time("", kToken));
}
