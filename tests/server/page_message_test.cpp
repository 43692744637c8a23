#include "server/shown/page_message.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace faba;
using Do = PageMessage::Do;

TEST_CASE("valid messages of the page") {
  CHECK(parse_page_message(R"({"id":1,"do":"pause"})").what == Do::pause);
  const PageMessage s = parse_page_message(R"({"id":2,"do":"start","scenario":{"swarm":[]},"seed":7})");
  CHECK(s.what == Do::start);
  CHECK(s.id == 2);
  CHECK(*s.seed == 7);
  CHECK(s.scenario.contains("swarm"));
  CHECK(
      parse_page_message(R"({"id":3,"do":"exchange","event":{"controller":"fuzzy"}})").event["controller"] ==
      "fuzzy");
  CHECK(parse_page_message(R"({"id":3,"do":"step"})").frames == 1);
  CHECK(parse_page_message(R"({"id":3,"do":"speed","factor":0.1})").factor == 0.1);
  CHECK(parse_page_message(R"({"id":3,"do":"look","camera":true})").camera);
  CHECK(parse_page_message(R"({"id":3,"do":"look","sites":512})").sites == 512);
  const PageMessage all = parse_page_message(R"({"id":4,"do":"save","name":"a"})");
  CHECK(all.from == 0);
  CHECK_FALSE(all.to);
  const PageMessage part = parse_page_message(R"({"id":4,"do":"save","name":"a","from":1.5,"to":3})");
  CHECK(part.from == 1.5);
  CHECK(*part.to == 3);
}

TEST_CASE("invalid messages throw an error") {
  const std::string deep =
      R"({"id":1,"do":"start","scenario":)" + std::string(100000, '[') + std::string(100000, ']') + "}";
  for (const std::string& bad : {std::string(),
                                 std::string("{"),
                                 std::string("null"),
                                 std::string("[1]"),
                                 std::string("\"pause\""),
                                 std::string(R"({"do":"pause"})"),
                                 std::string(R"({"id":"1","do":"pause"})"),
                                 std::string(R"({"id":-1,"do":"pause"})"),
                                 std::string(R"({"id":1e300,"do":"pause"})"),
                                 std::string(R"({"id":1,"do":"explode"})"),
                                 std::string(R"({"id":1,"do":5})"),
                                 std::string(R"({"id":1,"do":"start"})"),
                                 std::string(R"({"id":1,"do":"start","scenario":"scenes/steer.toml"})"),
                                 std::string(R"({"id":1,"do":"start","scenario":{},"seed":-3})"),
                                 std::string(R"({"id":1,"do":"speed","factor":33})"),
                                 std::string(R"({"id":1,"do":"speed","factor":0})"),
                                 std::string(R"({"id":1,"do":"speed"})"),
                                 std::string(R"({"id":1,"do":"step","frames":1e9})"),
                                 std::string(R"({"id":1,"do":"look","rate":0})"),
                                 std::string(R"({"id":1,"do":"look","sites":5000})"),
                                 std::string(R"({"id":1,"do":"look","sites":-1})"),
                                 std::string(R"({"id":1,"do":"save"})"),
                                 std::string(R"({"id":1,"do":"save","name":"a","from":-1})"),
                                 std::string(R"({"id":1,"do":"save","name":"a","to":"now"})"),
                                 std::string("\xff\xfe{\"id\":1}"),
                                 deep}) {
    INFO(bad.substr(0, 60));
    CHECK_THROWS_AS(parse_page_message(bad), const Error&);
  }
  CHECK(message_id(R"({"id":5,"do":"explode"})") == 5);
  CHECK(message_id("nonsense") == 0);
}
