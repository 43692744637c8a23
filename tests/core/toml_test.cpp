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
  CHECK(refusal("a = “x”\n").starts_with("t.toml:1: “ is a typographic quote; write a straight quote"));
}

TEST_CASE("frequent errors of the parser have advice") {
  CHECK(refusal("rate = 60 Hz\n").ends_with("need quotes, such as \"60 Hz\""));
  CHECK(refusal("a = 1\na = 2\n").ends_with("; remove one of the two"));
  CHECK(refusal("count = 5,5\n").ends_with("; write decimals with a point (5.5) and lists in [ ]"));
  CHECK(refusal("a = [18 uT, 0]\n").ends_with("; put quantities in quotes, such as [\"18 uT\", \"0 uT\"]"));
  CHECK(refusal("a = 1\ntitle = \"x\nb = 2\n") ==
        "t.toml:2: the text is not closed; add a quote (\") at its end");
  CHECK(refusal("a = 'x\n") == "t.toml:1: the text is not closed; add a quote (') at its end");
  CHECK(refusal("a = \"\"\"x\n").ends_with("the text is not closed; add a quote (\"\"\") at its end"));
  CHECK(refusal("a = \"x\x01\"\n").find("control characters") != std::string::npos);
  CHECK(refusal("a = 1\n[[swarm]\ncount = 3\n") == "t.toml:2: a closing bracket is missing: write [[swarm]]");
  CHECK(refusal("[limits\n") == "t.toml:1: a closing bracket is missing: write [limits]");
  CHECK(refusal("a = { b = 3,\n c = 4 }\n") ==
        "t.toml:1: a closing } is missing, or the table is longer than one line");
  CHECK(refusal("a =\n").find("Error while parsing") == std::string::npos);
  CHECK(refusal("a = \n") == "t.toml:1: expected value, saw '\\n'; write a value after =");
  CHECK(refusal("x_m,y_m\n1,2\n") ==
        "t.toml:1: expected '=', saw ','; check that this is a TOML file: its lines are KEY = VALUE, [table] "
        "or # comment");
  CHECK(refusal("{\"a\": 1}\n").find("check that this is a TOML file") != std::string::npos);
  CHECK(refusal("a = 'caf\xE9'\n").ends_with("; the file is not UTF-8; save it as UTF-8"));
}

TEST_CASE("invalid TOML is rejected, also where the parser accepts it") {
  for (const char* text : {"[+a]", "a = \"", "a = '''x", "= 1", "[[a]", "a = 1 1", "a = \"\\", "'", "\"\"\""})
    CHECK(refusal(text) != "accepted");
}

TEST_CASE("a value that is set replaces the lines of its own subtree only") {
  Document d = parse_toml("[a]\nb = { c = 1 }\nbc = 2\n[[a.list]]\nx = 1\n[[ab]]\ny = 1\n", "t.toml");
  d.set("a.b", Json(3), "--set");
  CHECK(d.origin.at("a.b") == "--set");
  CHECK_FALSE(d.origin.contains("a.b.c"));
  CHECK(d.origin.at("a.bc") == "t.toml:3");
  d.set("a.list", Json::array(), "--set");
  CHECK_FALSE(d.origin.contains("a.list[0]"));
  CHECK_FALSE(d.origin.contains("a.list[0].x"));
  d.set("a", Json::object(), "--set");
  CHECK_FALSE(d.origin.contains("a.bc"));
  CHECK(d.origin.at("ab[0].y") == "t.toml:7");
  CHECK(Node(d).child("ab").item(0).where("y") == "t.toml:7: ab[0].y");
}

TEST_CASE("keys that are not bare are written in quotes and read again") {
  const Json j = {{"set", {{"swarm[0].count", 20}, {"a \"b\"\n[c]", 1}, {"", 2}}},
                  {"x.y", {{"bare-key_1", true}}}};
  CHECK(parse_toml(to_toml(j), "t").root == j);
  CHECK(to_toml({{"bare-key_1", 1}}) == "bare-key_1 = 1\n");
}
