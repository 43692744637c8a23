#include "core/schema.h"

#include <doctest/doctest.h>

#include "core/registry.h"

using namespace faba;

namespace {

struct Inner {
  double weight = 0.5;
  static Schema<Inner> schema() {
    return Schema<Inner>("inner", "x").add("weight", &Inner::weight, {.min = 0, .max = 1});
  }
};
struct Params {
  enum class Colour { red, green };
  double speed = 1e-4;
  int count = 3;
  bool on = false;
  std::string name = "a";
  Colour colour = Colour::green;
  Vec2 at{1, 2};
  std::optional<double> extra;
  std::vector<Inner> inner;
  static Schema<Params> schema() {
    Params fast;
    fast.speed = 5e-4;
    return Schema<Params>("params", "For the test")
        .add("speed", &Params::speed, {.unit = "m/s", .min = 0, .max = 1e-3, .doc = "how fast"})
        .add("count", &Params::count, {.min = 0, .max = 10, .old_key = "number"})
        .add("on", &Params::on, {})
        .add("name", &Params::name, {})
        .add("colour", &Params::colour, {.choices = {"red", "green"}})
        .add("at", &Params::at, {.unit = "px"})
        .add("extra", &Params::extra, {.unit = "s", .min = 0})
        .add("inner", &Params::inner, {})
        .preset("fast", fast, "test");
  }
};

Params read(const std::string& toml) {
  const Document d = parse_toml(toml, "scene.toml");
  return Params::schema().parse(Node(d));
}
std::string refusal_of(const std::string& toml) {
  try {
    read(toml);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::usage);
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("values, units, presets, nested lists") {
  const Params p = read(
      "preset = 'fast'\ncount = 4.0\non = true\ncolour = 'red'\nat = [3, '4 px']\nextra = '2 ms'\n"
      "[[inner]]\nweight = 0.25\n[[inner]]\n");
  CHECK(p.speed == 5e-4);
  CHECK(p.count == 4);
  CHECK(p.on);
  CHECK(p.colour == Params::Colour::red);
  CHECK(p.at == Vec2{3, 4});
  CHECK(p.extra == 2e-3);
  REQUIRE(p.inner.size() == 2);
  CHECK(p.inner[0].weight == 0.25);
  CHECK(p.inner[1].weight == 0.5);
  CHECK(read("preset = 'fast'\nspeed = '1 um/s'").speed == 1e-6);
}

TEST_CASE("the former name of a key is read, but not together with the new name") {
  CHECK(read("number = 7").count == 7);
  CHECK(refusal_of("number = 7\ncount = 7").find("number: is the old name of \"count\"") !=
        std::string::npos);
  CHECK(refusal_of("number = 70").find("between 0 and 10") != std::string::npos);
  CHECK_FALSE(Params::schema().json_schema()["properties"].contains("number"));
  CHECK_FALSE(Params::schema().to_json(read("number = 7")).contains("number"));
}

TEST_CASE("suggestion: only for a typing error, else the known words") {
  const std::vector<std::string> known = {"run", "flow"};
  CHECK(suggestion("rnu", known) == "; did you mean \"run\"?");
  CHECK(suggestion("flwo", known) == "; did you mean \"flow\"?");
  CHECK(suggestion("foo", known) == "; known: run, flow");
  CHECK(suggestion("foo", {}).empty());
}

TEST_CASE("every error message is one line with file, line, path, reason and advice") {
  CHECK(refusal_of("count = 1\nsped = 1") == "scene.toml:2: sped: unknown key; did you mean \"speed\"?");
  CHECK(refusal_of("speed = '3 um'") ==
        "scene.toml:1: speed: \"3 um\" is a length; expected a speed such as \"1 m/s\"");
  CHECK(refusal_of("speed = nan") == "scene.toml:1: speed: must be a finite number, got nan");
  CHECK(refusal_of("speed = inf") == "scene.toml:1: speed: must be a finite number, got inf");
  CHECK(refusal_of("speed = 1e300") ==
        "scene.toml:1: speed: 1e+300 (without a unit: m/s) is out of range; it must be between 0 m/s and "
        "0.001 m/s");
  CHECK(refusal_of("speed = true") == "scene.toml:1: speed: expected a speed such as \"1 m/s\", got true");
  CHECK(refusal_of("count = 2.5") == "scene.toml:1: count: expected an integer, got 2.5");
  CHECK(refusal_of("count = 99999999999999999999") != "accepted");
  CHECK(refusal_of("colour = 'blue'") == "scene.toml:1: colour: \"blue\" is not one of red, green");
  CHECK(refusal_of("on = 1") == "scene.toml:1: on: expected true or false, got 1");
  CHECK(refusal_of("at = [1]") == "scene.toml:1: at: expected 2 values, got 1");
  CHECK(refusal_of("name = [1]") == "scene.toml:1: name: expected a string, got [1]");
  CHECK(refusal_of("preset = 'quick'") == "scene.toml:1: preset: \"quick\" is not one of fast");
  CHECK(refusal_of("\n\n[[inner]]\nwieght = 1") ==
        "scene.toml:4: inner[0].wieght: unknown key; did you mean \"weight\"?");
  CHECK(refusal_of("speed = '-3 um/s'") ==
        "scene.toml:1: speed: -3 um/s is out of range; it must be between 0 um/s and 1000 um/s");
  CHECK(refusal_of("extra = '-1 s'") == "scene.toml:1: extra: -1 s is out of range; it must be at least 0 s");
}

TEST_CASE("parameters written by a schema are read back bit by bit") {
  const Params p = read("speed = '0.1 mm/s'\nextra = '0.3 s'\nat = [0.1, 0.7]\n[[inner]]\nweight = 0.3");
  const Json j = Params::schema().to_json(p);
  const Document d = parse_toml(to_toml(j), "again");
  CHECK(Params::schema().to_json(Params::schema().parse(Node(d))) == j);
}

TEST_CASE("--set changes one value and is named in error messages") {
  Document d = parse_toml("[swarm]\ncount = 1\n[[list]]\na = 1\n", "f.toml");
  d.set("swarm.count", std::string("7"), "--set");
  CHECK(d.root["swarm"]["count"] == 7);
  d.set("list[0].b", std::string("12 um/s"), "--set");
  CHECK(d.root["list"][0]["b"] == "12 um/s");
  d.set("new.deep", std::string("[1, 2]"), "--set");
  CHECK(d.root["new"]["deep"] == Json::array({1, 2}));
  CHECK(Node(d).where("swarm.count") == "--set: swarm.count");
  for (const char* bad :
       {"list[3].a", "swarm.count.x", "", "a..b", "a[", "a[x]", "swarm[0].count", "a.", "[0]", "a[-1]"})
    CHECK_THROWS_AS(d.set(bad, std::string("1"), "--set"), Error);
  CHECK_THROWS_WITH_AS(d.set("list.a", std::string("1"), "--set"),
                       "--set list.a: \"list\" is an array; write list[0].a", Error);
  CHECK_THROWS_WITH_AS(
      d.set("rig.coil[0].a", std::string("1"), "--set"),
      "--set rig.coil[0].a: the file has no [[rig.coil]]; add one for each element to the file", Error);
  d.set("swarm.repeat", std::string("1"), "--repeat");
  CHECK(Node(d).where("swarm.repeat") == "--repeat");
  d.set("swarm.set", std::string("1"), "--set");
  CHECK(Node(d).where("swarm.set") == "--set: swarm.set");
  CHECK_THROWS_WITH_AS(d.set("list[3].a", std::string("1"), "--set"),
                       "--set list[3].a: list[3] not found; \"list\" has 1 element; add more in the file",
                       Error);
}

TEST_CASE("registry: parts by name or table; the message for an unknown name has the most similar one") {
  struct Animal {
    virtual ~Animal() = default;
    virtual int legs() const = 0;
  };
  struct None {};
  struct Dog final : Animal {
    struct Params {
      int legs = 4;
    };
    static Schema<Params> schema() {
      return Schema<Params>("dog", "barks").add("legs", &Params::legs, {.min = 0, .max = 4});
    }
    Dog(const Params& p, const None&) : n(p.legs) {}
    int legs() const override { return n; }
    int n;
  };
  Registry<Animal, None> r("animal", "test");
  r.add<Dog>();
  CHECK_THROWS_AS(r.add<Dog>(), Error);
  const Document d =
      parse_toml("a = 'dog'\nb = { type = 'dog', legs = 3 }\nc = 'dgo'\ne = { legs = 1 }\nf = 3", "z.toml");
  CHECK(r.resolve(Node(d).child("a")).make({})->legs() == 4);
  CHECK(r.resolve(Node(d).child("b")).make({})->legs() == 3);
  CHECK(r.resolve(Node(d).child("b")).resolved == Json{{"type", "dog"}, {"legs", 3}});
  Document changed = parse_toml("b = { type = 'cat', claws = 3 }", "z.toml");
  changed.set("b.type", std::string("dog"), "--set");
  CHECK_THROWS_WITH_AS(
      r.resolve(Node(changed).child("b")),
      "z.toml:1: b.claws: unknown key; to change the type, replace the complete table: --set "
      "'b={type=\"dog\"}'; known: type, legs",
      Error);
  CHECK_THROWS_WITH(r.resolve(Node(d).child("c")),
                    "z.toml:3: c.type: unknown animal \"dgo\"; did you mean \"dog\"?");
  CHECK_THROWS_WITH(r.resolve(Node(d).child("e")),
                    "z.toml:4: e: key \"type\" is missing; known animals: dog");
  CHECK_THROWS_AS(r.resolve(Node(d).child("f")), Error);
}

namespace {

struct Outer {
  Inner inner;
  int n = 0;
  static Schema<Outer> schema() {
    auto noted = Inner::schema();
    noted.note([](const Inner& i) { return std::string(i.weight == 0 ? "weight is 0: no effect" : ""); });
    return Schema<Outer>("outer", "With the fields and notes of another struct")
        .add("n", &Outer::n, {})
        .include(&Outer::inner, noted)
        .note([](const Outer& o) { return std::string(o.n < 0 ? "n is negative" : ""); });
  }
};

}  // namespace

TEST_CASE("notes on values: of a schema and of those that it includes; notes are not errors") {
  const auto notes = [](const char* toml) {
    const Document d = parse_toml(toml, "t.toml");
    return Outer::schema().notes(Outer::schema().parse(Node(d)));
  };
  CHECK(notes("n = 1\n").empty());
  CHECK(notes("weight = 0\n") == std::vector<std::string>{"weight is 0: no effect"});
  CHECK(notes("weight = 0\nn = -1\n").size() == 2);
}
