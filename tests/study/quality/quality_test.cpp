#include "study/quality/quality.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "study/pages/quality_output.h"

using namespace faba;

TEST_CASE("the quality is that of the worst warning, and good without one") {
  CHECK(quality_of({}) == Quality::good);
  const Warning doubtful{"scale", "a", "", "", Quality::doubtful}, poor{"focus", "b", "", "", Quality::poor};
  CHECK(quality_of({doubtful}) == Quality::doubtful);
  CHECK(quality_of({doubtful, poor, doubtful}) == Quality::poor);
}

TEST_CASE("a warning is one sentence, in JSON its parts") {
  const Warning w{"focus", "the edge is blurred", "10 px < 20", "focus on the edge", Quality::poor};
  CHECK(sentence(w) == "focus: the edge is blurred (10 px < 20); focus on the edge");
  CHECK(sentence({"a", "b", "", "", Quality::good}) == "a: b");
  nlohmann::ordered_json j;
  add_quality(j, {w});
  CHECK(j["quality"] == "poor");
  CHECK(j["warnings"][0]["aspect"] == "focus");
  CHECK(j["warnings"][0]["evidence"] == "10 px < 20");
  CHECK(quality_markup({w}).find("10 px &lt; 20") != std::string::npos);
  CHECK(quality_markup({}).empty());
}
