// Requests of the gallery and of the page for the user's own drop.
#include <doctest/doctest.h>

#include "core/toml.h"
#include "tests/server/served_lab.h"

using namespace faba;
using test::Served;
using test::status_of;
namespace fs = std::filesystem;

TEST_CASE(
    "pictures: errors have the name of the user's file, and no file outside of the workspace is shown") {
  const Served lab;
  const std::string bytes = lab.own() + "Content-Type: application/octet-stream\r\n";
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  const auto error = [](const std::string& answer) { return Json::parse(test::body_of(answer)); };
  for (const char* content : {"these are notes", "", "P5\n640 480\n255\nshort"}) {
    const std::string a = lab.ask("POST /api/upload?name=..%2fmy%20notes.pgm", bytes, content);
    INFO(a);
    CHECK(status_of(a) == 422);
    CHECK(error(a)["where"] == "my notes.pgm");
    for (const char* part : {"upload-", ".part", "/tmp", "original-"})
      CHECK(a.find(part) == std::string::npos);
  }
  std::string picture = "P5\n80 64\n255\n";
  for (int i = 0; i < 80 * 64; ++i) picture += char(60 + i % 80);
  const std::string a = lab.ask("POST /api/upload?name=flat.pgm", bytes, picture);
  REQUIRE(status_of(a) == 200);
  const Json found = error(a);
  CHECK(found["found"] == false);
  const std::string upload = found["upload"];
  const auto keep = [&](const std::string& what) {
    return lab.ask("POST /api/pictures/keep", json, Json{{"upload", what}, {"name", "flat.pgm"}}.dump());
  };
  CHECK(error(keep(upload))["file"] == "pictures/flat.pgm");
  CHECK(read_file(lab.folder() / "pictures/flat.pgm") == picture);
  for (const char* bad : {"original-99.pgm", "../secret.txt", "original-/../../secret.txt", "shown-1.png"})
    CHECK(status_of(keep(bad)) >= 400);
  CHECK(test::body_of(lab.get("/api/pictures/shown.png?file=pictures/flat.pgm")).starts_with("\x89PNG"));
  CHECK(error(lab.get("/api/pictures")) == Json({"pictures/flat.pgm"}));
  const std::string again = lab.ask("POST /api/pictures/detect", json, R"({"file": "pictures/flat.pgm"})");
  CHECK(error(again)["file"] == "pictures/flat.pgm");
  for (const char* bad : {"/etc/passwd", "../secret.txt", "secret.txt", "none.png", ""}) {
    INFO(bad);
    CHECK(status_of(lab.get(std::string("/api/pictures/shown.png?file=") + bad)) >= 400);
    CHECK(status_of(lab.ask("POST /api/pictures/detect", json, Json{{"file", bad}}.dump())) >= 400);
  }
}

TEST_CASE("the index of the gallery orders the scenes; the others and a damaged index follow") {
  const Served lab;
  const auto names = [&] {
    std::vector<std::string> all;
    for (const Json& s : Json::parse(test::body_of(lab.get("/api/scenes")))) all.push_back(s["name"]);
    return all;
  };
  write_file(lab.folder() / "scenes/two.toml", "title = 'Two'\n[[swarm]]\nmodel = 'basic'\n");
  write_file(lab.folder() / "scenes/gallery.toml",
             "[[scene]]\nname = 'two'\npurpose = 'thesis'\nsummary = 'S.'\n[[scene]]\nname = 'gone'\n");
  CHECK(names() == std::vector<std::string>{"two", "one"});
  const Json two = Json::parse(test::body_of(lab.get("/api/scenes")))[0];
  CHECK(two["purpose"] == "thesis");
  CHECK(two["summary"] == "S.");
  CHECK(two["models"] == Json({"basic"}));
  CHECK(two["controller"] == "fuzzy");
  write_file(lab.folder() / "scenes/gallery.toml", "[[scene]]\npurpose = 'fun'\n");
  CHECK(names() == std::vector<std::string>{"gallery.toml", "one", "two"});
}

TEST_CASE("a copy of a scene may differ in the tables of its coils only") {
  const Served lab;
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  const std::string scene = "# A bench.\n[[swarm]]\ncount = 1\n[rig]\n";
  write_file(lab.folder() / "scenes/bench.toml", scene);
  const auto save = [&](const std::string& name, const std::string& toml, const char* of = "bench") {
    return lab.ask("POST /api/scenes", json, Json{{"name", name}, {"copy_of", of}, {"toml", toml}}.dump());
  };
  const std::string coil =
      "[[rig.coil]]\nchannel = 'a'\npolarity = -1\n[[rig.coil]]\nchannel = 'b'\ntable = [[0, -0.5], [5, "
      "0.5]]\n";
  const std::string two = scene + coil;
  const std::string a = save("measured", two);
  INFO(a);
  REQUIRE(status_of(a) == 200);
  CHECK(Json::parse(test::body_of(a)) == Json({{"name", "measured"}, {"file", "scenes/measured.toml"}}));
  CHECK(read_file(lab.folder() / "scenes/measured.toml") == two);
  CHECK(status_of(save("measured", two)) >= 400);  // exists
  CHECK(status_of(save("none", two, "none")) >= 400);
  for (const char* bad : {"", "../out", "a/b", ".hidden", "ponto.ção"}) {
    INFO(bad);
    CHECK(status_of(save(bad, two)) >= 400);
  }
  const std::string driver = scene + "driver = { type = 'nidaqmx', library = '/tmp/other.so' }\n" + coil;
  for (const std::string& other :
       {driver, scene + "[[rig.coil]]\nchannel = 'a'\npolarity = 3\n[[rig.coil]]\nchannel = 'b'\n",
        std::string("not toml"), scene + "[arena]\ntype = 'box'\n"}) {
    INFO(other);
    CHECK(status_of(save("other", other)) >= 400);
    CHECK_FALSE(fs::exists(lab.folder() / "scenes/other.toml"));
    CHECK(save("other", other).find(lab.folder().string()) == std::string::npos);
  }
}
