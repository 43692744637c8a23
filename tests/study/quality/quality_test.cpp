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
}

TEST_CASE("a page explains the quality and shows title, evidence and advice of a warning") {
  const std::string good = quality_markup({}),
                    bad = quality_markup({{"frame_rate", "too slow", "", "use 60 Hz"}});
  CHECK(good.find("Quality of the measurement: good") != std::string::npos);
  CHECK(good.find(meaning_of(Quality::good)) != std::string::npos);
  CHECK(bad.find(meaning_of(Quality::doubtful)) != std::string::npos);
  CHECK(bad.find("<b>Frame rate</b>") != std::string::npos);
  CHECK(bad.find("<dt>Advice</dt><dd class=\"sentence\">use 60 Hz</dd>") != std::string::npos);
  CHECK(bad.find("Evidence") == std::string::npos);
  const std::string both =
      quality_markup({{"focus", "blurred", "a: 3", "focus"}, {"focus", "blurred", "b: 4", "focus"}});
  CHECK(both.find("blurred") == both.rfind("blurred"));
  CHECK(both.find("a: 3</dd>\n<dd>b: 4") != std::string::npos);
  CHECK(title_of_aspect("of_no_list") == "of no list");
}
