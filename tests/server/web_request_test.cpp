#include "server/web_request.h"

#include <doctest/doctest.h>

using namespace faba;

TEST_CASE("a target is parsed") {
  const auto t = parse_target("/api/runs/my%20run/series.csv?from=3&name=a+b%26c&token=x");
  REQUIRE(t);
  CHECK(t->path == "/api/runs/my run/series.csv");
  CHECK(t->query.at("from") == "3");
  CHECK(t->query.at("name") == "a b&c");
  CHECK(parse_target("/")->path == "/");
  CHECK(parse_target("/a+b")->path == "/a+b");
  CHECK(parse_target("/?")->query.empty());
}

TEST_CASE("S6: parent folders, invalid escapes, control characters and overlong targets are refused") {
  for (const char* bad : {"",
                          "api",
                          "http://evil.example/",
                          "/../etc/passwd",
                          "/a/../b",
                          "/a/..",
                          "/./a",
                          "//etc/passwd",
                          "/a//b",
                          "/%2e%2e/etc",
                          "/a%2f..%2fb",
                          "/a\\b",
                          "/%5c..",
                          "/a%00b",
                          "/a%0ab",
                          "/a%zz",
                          "/a%2",
                          "/a%",
                          "/?x=%00",
                          "/?x=%f"}) {
    INFO(bad);
    CHECK_FALSE(parse_target(bad));
  }
  CHECK_FALSE(parse_target("/" + std::string(9000, 'a')));
}

TEST_CASE("byte ranges") {
  const auto is = [](const char* header, std::uint64_t begin, std::uint64_t end) {
    const auto r = parse_range(header, 1000);
    return r && r->begin == begin && r->end == end;
  };
  CHECK(is("bytes=0-499", 0, 500));
  CHECK(is("bytes=500-", 500, 1000));
  CHECK(is("bytes=-300", 700, 1000));
  CHECK(is("bytes=-5000", 0, 1000));
  CHECK(is("bytes=999-20000", 999, 1000));
  for (const char* bad : {"", "bytes=", "bytes=-", "bytes=-0", "bytes=5-4", "bytes=1000-", "bytes=a-b",
                          "bytes=1-2,4-5", "lines=1-2", "bytes=99999999999999999999-"}) {
    INFO(bad);
    CHECK_FALSE(parse_range(bad, 1000));
  }
  CHECK_FALSE(parse_range("bytes=0-", 0));
}
