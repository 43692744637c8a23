#include "server/request_values.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace faba;

TEST_CASE("a text must not be empty") {
  CHECK(text_of({{"verb", "activity"}}, "verb") == "activity");
  for (const Json& asked : {Json::object(), Json{{"verb", ""}}, Json{{"verb", 3}}})
    CHECK_THROWS_WITH_AS(text_of(asked, "verb"), doctest::Contains("verb: missing"), const Error&);
}

TEST_CASE("an imported file is named without its folder") {
  CHECK(file_name_of({{"name", "bad1.toml"}}) == "bad1.toml");
  CHECK(file_name_of({{"name", "../../etc/x.toml"}}) == "x.toml");
  CHECK(file_name_of(Json::object()) == "file");
  CHECK(file_name_of({{"name", std::string(5000, 'a')}}) == "file");
}
