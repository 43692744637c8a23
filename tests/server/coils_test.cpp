// The requests of the editor of coil systems: field and strength, opening, saving, and what is refused.
#include <doctest/doctest.h>

#include "app/scenario/rig_file.h"
#include "core/toml.h"
#include "tests/server/served_lab.h"

using namespace faba;
using test::Served;
using test::status_of;
namespace fs = std::filesystem;

namespace {

Json answer(const std::string& response) { return Json::parse(test::body_of(response)); }

std::string post(const Served& lab, const std::string& path, const Json& body) {
  return lab.ask("POST " + path, lab.own() + "Content-Type: application/json\r\n", body.dump());
}

Json coil(const char* x, int axis) {
  return {{"type", "solenoid"},   {"name", x},          {"position", {x, 0, 0}},
          {"axis", {axis, 0, 0}}, {"current", "0.5 A"}, {"max_current", "0.5 A"}};
}
Json facing() { return {{"coil", {coil("35 mm", -1), coil("-35 mm", 1)}}}; }

Json request(const Json& system) {
  return {{"system", system},
          {"width_m", 0.02},
          {"height_m", 0.02},
          {"columns", 8},
          {"rows", 4},
          {"side", true},
          {"probe_m", {0, 0, 0}},
          {"target_m", {0, 0}},
          {"polarity", "north"},
          {"sample_m", 1e-3},
          {"model", {{"type", "dipole"}, {"preset", "IT-1"}}}};
}

// The place and the reason of a refused request.
void check_refused(const Served& lab, Json body, const char* where, const char* what) {
  const std::string response = post(lab, "/api/coils/evaluate", body);
  CHECK(status_of(response) == 422);
  const Json j = answer(response);
  CAPTURE(j.dump());
  CHECK(j["where"] == where);
  CHECK(j["what"].get<std::string>().find(what) != std::string::npos);
}

Json changed(const char* key, const Json& value) {
  Json body = request(facing());
  body[key] = value;
  return body;
}

}  // namespace

TEST_CASE("a coil system is evaluated: grids, zeros, trap and strength") {
  const Served lab;
  const Json j = answer(post(lab, "/api/coils/evaluate", request(facing())));
  REQUIRE(j["grids_nt"].size() == 2);
  CHECK(j["grids_nt"][0].size() == 3 * 8 * 4);
  REQUIRE(j["zeros"].size() == 1);
  CHECK(j["zeros"][0]["kind"] == "saddle");
  CHECK(std::fabs(j["probe_t"][0].get<double>()) < 1e-12);
  CHECK(j["trap"]["saddle"] == true);
  CHECK(j["hold"]["steering_t"]["met"] == false);
  CHECK(j["hold"]["u_turn_m"].is_null());
  CHECK(j["limits_a"] == Json({0.5, 0.5}));
}

TEST_CASE("requests out of range are refused with the permitted values") {
  const Served lab;
  check_refused(lab, changed("columns", 65), "columns", "between 1 and 64");
  check_refused(lab, changed("width_m", 1e9), "width_m", "between 0.0001 and 10");
  check_refused(lab, changed("probe_m", {0, 0}), "probe_m", "3 coordinates");
  check_refused(lab, changed("target_m", {0, 1e300}), "target_m", "2 coordinates");
  check_refused(lab, changed("polarity", "east"), "polarity", "north or south");
  check_refused(lab, changed("sample_m", 0), "sample_m", "between");
  check_refused(lab, changed("model", "basic"), "model", "magnetic moment");
  check_refused(lab, changed("system", 3), "system", "must be a table");
  check_refused(lab, changed("system", {{"coil", Json::array()}}), "coil", "add at least one");
  Json many = facing();
  for (int k = 0; k < 23; ++k) many["coil"].push_back(coil("35 mm", 1));
  check_refused(lab, changed("system", many), "coil", "at most 24");
  Json strong = facing();
  strong["coil"][0]["turns"] = 1e12;
  check_refused(lab, changed("system", strong), "coil[0].turns", "out of range");
  Json map = facing();
  map["coil"][1] = {{"type", "map"}, {"file", "/etc/passwd"}};
  check_refused(lab, changed("system", map), "coil[1]", "measured map");
}

TEST_CASE("a saved coil system is accepted by the program, and replaced only on request") {
  const Served lab;
  Json body{{"name", "new"}, {"system", facing()}};
  const Json first = answer(post(lab, "/api/coils", body));
  CHECK(first["file"] == "rigs/new.toml");
  CHECK(first["exists"] == false);
  const fs::path file = lab.folder() / "rigs/new.toml";
  CHECK(read_rig(file, builtin_parts()).make({})->coils() == 2);
  CHECK(read_file(file) == first["toml"]);

  body["system"]["coil"].erase(1);
  CHECK(answer(post(lab, "/api/coils", body))["exists"] == true);
  CHECK(read_rig(file, builtin_parts()).make({})->coils() == 2);
  body["replace"] = true;
  CHECK(answer(post(lab, "/api/coils", body))["exists"] == false);
  CHECK(read_rig(file, builtin_parts()).make({})->coils() == 1);

  const Json opened = answer(lab.get("/api/coils/rigs/new.toml"));
  CHECK(opened["system"] == body["system"]);
  CHECK(opened["resolved"]["coil"][0]["turns"] == 400);
  CHECK(answer(lab.get("/api/coils")).dump().find("rigs/new.toml") != std::string::npos);
}

TEST_CASE("S2: coil systems are read and written in the workspace only") {
  const Served lab;
  for (const char* name : {"../x", "a/b", ".hidden", "-o", "a b", "x.toml"}) {
    const std::string response = post(lab, "/api/coils", {{"name", name}, {"system", facing()}});
    CHECK(status_of(response) == 422);
  }
  CHECK(status_of(post(lab, "/api/coils",
                       {{"name", "x"}, {"system", {{"coil", Json::array({Json{{"type", "x"}}})}}}})) == 422);
  CHECK_FALSE(fs::exists(lab.folder() / "rigs/x.toml"));
  fs::create_directory_symlink(fs::temp_directory_path(), lab.folder() / "rigs");
  CHECK(status_of(post(lab, "/api/coils", {{"name", "faba-test"}, {"system", facing()}})) == 422);
  CHECK_FALSE(fs::exists(fs::temp_directory_path() / "faba-test.toml"));
  CHECK(status_of(lab.get("/api/coils/rigs/absent.toml")) != 200);
  CHECK(status_of(lab.get("/api/coils/%2Fetc%2Fpasswd")) != 200);
  CHECK(status_of(lab.get("/api/coils/secret.txt")) == 422);
}
