#include "server/access.h"

#include <doctest/doctest.h>

using namespace faba;

namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";
const Access kAccess(kToken, 8123);

/// A request of the lab's own page, with the cookie.
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
int judged(const Credentials& c) { return kAccess.judge(c).status; }

}  // namespace

TEST_CASE("the lab's own page may ask") {
  CHECK(judged(own()) == 200);
  CHECK(judged(own("POST")) == 200);
  Credentials c = own();
  c.cookie.clear();
  c.query_token = kToken;
  CHECK(judged(c) == 200);
  CHECK(kAccess.judge(c).by_token);
  c.query_token.clear();
  c.authorization = {"Bearer " + kToken};
  CHECK(judged(c) == 200);
  c = own();
  c.host = {"localhost:8123"};
  CHECK(judged(c) == 200);
}

TEST_CASE("S2: no token, no answer") {
  Credentials c = own();
  c.cookie.clear();
  CHECK(judged(c) == 401);
  c.upgrade = true;
  c.origin = {"http://127.0.0.1:8123"};
  CHECK(judged(c) == 401);
  for (const std::string& wrong : {kToken.substr(1), kToken + "0", "f" + kToken.substr(1), std::string()}) {
    c = own();
    c.cookie = {"faba-8123=" + wrong};
    CHECK(judged(c) == 401);
    c.cookie.clear();
    c.query_token = wrong;
    CHECK(judged(c) == 401);
    c.query_token.clear();
    c.authorization = {"Bearer " + wrong};
    CHECK(judged(c) == 401);
  }
  c = own();
  c.cookie = {"faba-8124=" + kToken};  // of a lab on another port
  CHECK(judged(c) == 401);
}

TEST_CASE("S3: names that lead here by a trick, no name, two names") {
  for (const char* host : {"evil.example", "evil.example:8123", "127.0.0.1.evil.example:8123", "127.0.0.1",
                           "127.0.0.1:80", "localhost", "[::1]:8123", "0.0.0.0:8123", ""}) {
    Credentials c = own();
    c.host = {host};
    INFO(host);
    CHECK(judged(c) == 403);
  }
  Credentials c = own();
  c.host.clear();
  CHECK(judged(c) == 403);
  c.host = {"127.0.0.1:8123", "127.0.0.1:8123"};
  CHECK(judged(c) == 403);
}

TEST_CASE(
    "S4: a socket is opened from the lab's own origin only (CVE-2025-30360: addresses in numbers, too)") {
  Credentials c = own();
  c.upgrade = true;
  CHECK(judged(c) == 403);  // says nothing of where it comes from
  for (const char* origin : {"http://127.0.0.1:8124", "http://127.0.0.1", "https://127.0.0.1:8123", "null",
                             "http://1.2.3.4", "http://1.2.3.4:8123", "file://",
                             "http://127.0.0.1:8123.evil.example", "http://127.0.0.1:81234", ""}) {
    c.origin = {origin};
    INFO(origin);
    CHECK(judged(c) == 403);
  }
  c.origin = {"http://127.0.0.1:8123", "http://1.2.3.4"};
  CHECK(judged(c) == 403);
  c.origin = {"http://127.0.0.1:8123"};
  CHECK(judged(c) == 200);
}

TEST_CASE("S5: what forms of other pages can send is not taken") {
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
    Credentials c = own("POST");
    c.content_type = type;
    INFO(type);
    CHECK(judged(c) == 415);
  }
  Credentials c = own("POST");
  c.origin.clear();  // browsers always say it
  CHECK(judged(c) == 403);
  c = own("DELETE");
  c.origin = {"http://127.0.0.1:9999"};
  CHECK(judged(c) == 403);
}

TEST_CASE("a page on another port has the same site, so its browser sends the cookie: it does not count") {
  for (const char* site : {"same-site", "cross-site"}) {
    Credentials c = own();
    c.fetch_site = {site};
    CHECK(judged(c) == 401);
  }
}

TEST_CASE("S8: tokens differ, are long, and the cookie is no script's business") {
  CHECK(random_token() != random_token());
  CHECK(random_token().size() == 32);
  CHECK(kAccess.cookie().find("HttpOnly") != std::string::npos);
  CHECK(kAccess.cookie().find("SameSite=Strict") != std::string::npos);
  CHECK(equal_in_constant_time(kToken, kToken));
  CHECK_FALSE(equal_in_constant_time(kToken, ""));
  CHECK_FALSE(equal_in_constant_time("", kToken));
}
