#include "server/request_values.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace faba;

TEST_CASE("a text must not be empty") {
  CHECK(text_of({{"verb", "activity"}}, "verb") == "activity");
  for (const Json& asked : {Json::object(), Json{{"verb", ""}}, Json{{"verb", 3}}})
    CHECK_THROWS_WITH_AS(text_of(asked, "verb"), doctest::Contains("verb: missing"), const Error&);
}

TEST_CASE("a list of numbers is returned as it was sent") {
  for (const char* list : {"0.5", "0.5, -0.5", "1e-3,.5 , +2"})
    CHECK(numbers_of({{"current", list}}, "current") == list);
  for (const char* list : {" ", "1,", ",1", "1,,2", "1 2", "1;2", "0.5 A", "nan", "inf", "1e999", "--help"}) {
    INFO(list);
    CHECK_THROWS_WITH_AS(numbers_of({{"current", list}}, "current"), doctest::Contains("current: "),
                         const Error&);
  }
  CHECK_THROWS_AS(numbers_of(Json::object(), "current"), const Error&);
}

TEST_CASE("an imported file is named without its folder") {
  CHECK(file_name_of({{"name", "bad1.toml"}}) == "bad1.toml");
  CHECK(file_name_of({{"name", "../../etc/x.toml"}}) == "x.toml");
  CHECK(file_name_of(Json::object()) == "file");
  CHECK(file_name_of({{"name", std::string(5000, 'a')}}) == "file");
}
