#include "core/toml.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace faba;

namespace {

std::string refusal(std::string_view text) {
  try {
    parse_toml(text, "t.toml");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::usage);
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("non-ASCII characters: in strings and comments, not in keys") {
  const Document d = parse_toml(
      "\xEF\xBB\xBFtitle = \"µm\" # Ό\nb = 'ü # no comment'\nc = \"\"\"a\"é\nö\"\"\"\nd = '''\n\"ß'''\ne = "
      "\"\\\"ä\"\n",
      "t.toml");
  CHECK(d.root["title"] == "µm");
  CHECK(d.root["b"] == "ü # no comment");
  CHECK(d.root["c"] == "a\"é\nö");
  CHECK(d.root["d"] == "\"ß");
  CHECK(d.root["e"] == "\"ä");
  CHECK(refusal("a = 1\nµ = 1\n") ==
        "t.toml:2: non-ASCII characters are permitted in strings and comments only");
  CHECK(refusal("a = 'x'\n\n[Ό]\n").starts_with("t.toml:3: non-ASCII"));
}

TEST_CASE("invalid TOML is rejected, also where the parser accepts it") {
  for (const char* text : {"[+a]", "a = \"", "a = '''x", "= 1", "[[a]", "a = 1 1", "a = \"\\", "'", "\"\"\""})
    CHECK(refusal(text) != "accepted");
}
